//! What every figure is: a drawing of a given size and the table behind it.

use super::canvas::{self, Canvas, Size};
use super::error::ReportError;
use super::result_files::write_bytes;
use super::table::Table;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// A file format of figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// Bitmap, 1600 pixels wide for one column of a paper.
    Png,
    /// Vector graphics.
    Svg,
}

/// A figure of a report. Figures of a report are drawn at the same time.
pub trait Figure: std::fmt::Debug + Sync {
    /// Stem of its files, as in `workspace.png`.
    fn name(&self) -> &str;
    /// A sentence that tells what is to be seen, as plain text.
    fn caption(&self) -> String;
    /// Size when printed.
    fn size(&self) -> Size;
    /// Draws on a white canvas of that size.
    fn draw(&self, canvas: &mut Canvas);
    /// The numbers behind the picture.
    fn table(&self) -> Table;
}

/// The figure as a PNG file's bytes.
pub fn figure_png(figure: &dyn Figure) -> Result<Vec<u8>, ReportError> {
    canvas::png(figure.size(), |sheet| figure.draw(sheet))
}

/// The figure as an SVG document.
pub fn figure_svg(figure: &dyn Figure) -> Result<String, ReportError> {
    canvas::svg(figure.size(), |sheet| figure.draw(sheet))
}

/// Writes the figure in the given formats and its table as CSV; returns the files' paths.
/// Missing directories are created.
pub fn write_figure(
    figure: &dyn Figure,
    directory: &Path,
    formats: &[Format],
) -> Result<Vec<PathBuf>, ReportError> {
    let svg = figure_svg(figure)?;
    let png = match formats.contains(&Format::Png) {
        true => canvas::png_of(&svg, figure.size())?,
        false => Vec::new(),
    };
    write_drawn(figure, &Drawn { svg, png }, directory, formats)
}

/// A figure in both formats.
pub(super) struct Drawn {
    pub svg: String,
    pub png: Vec<u8>,
}

impl Drawn {
    /// Draws once: pictures of workspaces take their time.
    pub fn new(figure: &dyn Figure) -> Result<Drawn, ReportError> {
        let svg = figure_svg(figure)?;
        let png = canvas::png_of(&svg, figure.size())?;
        Ok(Drawn { svg, png })
    }
}

/// [`write_figure`] of a figure that has been drawn.
pub(super) fn write_drawn(
    figure: &dyn Figure,
    drawn: &Drawn,
    directory: &Path,
    formats: &[Format],
) -> Result<Vec<PathBuf>, ReportError> {
    let mut written = Vec::new();
    let mut save = |extension: &str, bytes: &[u8]| {
        let path = directory.join(format!("{}.{extension}", figure.name()));
        write_bytes(&path, bytes)?;
        written.push(path);
        Ok::<(), ReportError>(())
    };
    if formats.contains(&Format::Png) {
        save("png", &drawn.png)?;
    }
    if formats.contains(&Format::Svg) {
        save("svg", drawn.svg.as_bytes())?;
    }
    save("csv", figure.table().to_csv()?.as_bytes())?;
    Ok(written)
}
