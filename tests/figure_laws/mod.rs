//! The laws of every figure.

use faultspace::report::{Figure, figure_svg};

/// The drawing, after the laws of every figure: a whole document without numbers that are none, a
/// caption, cells under every column.
pub fn draw(figure: &dyn Figure) -> String {
    let svg = figure_svg(figure).unwrap();
    roxmltree::Document::parse(&svg).unwrap();
    assert!(!svg.contains("NaN") && !svg.contains("\"inf"));
    let size = figure.size();
    assert!(
        size.width <= 504.0 && (20.0..=700.0).contains(&size.height),
        "{size:?}"
    );
    assert!(!figure.caption().is_empty());
    let table = figure.table();
    assert!(table.rows.iter().all(|row| row.len() == table.header.len()));
    svg
}
