//! From SVG to PNG, and how wide a text gets on the way. Only the embedded fonts are used, so that
//! no figure depends on the fonts of the machine.

use super::error::ReportError;
use super::subscript::{marked, with_tags};
use resvg::tiny_skia::{Color, IntSize, Pixmap, Transform};
use resvg::usvg::{Node, Options, Tree, fontdb};
use std::sync::{Arc, LazyLock};

static NORMAL: &[u8] = include_bytes!("../../assets/DejaVuSans-sub.ttf");
static BOLD: &[u8] = include_bytes!("../../assets/DejaVuSans-Bold-sub.ttf");

/// Fonts of an SVG's texts: the embedded one, or Verdana of the same metrics.
pub(super) const FAMILY: &str = "DejaVu Sans, Verdana, sans-serif";

static OPTIONS: LazyLock<Options<'static>> = LazyLock::new(|| {
    let mut fonts = fontdb::Database::new();
    for font in [NORMAL, BOLD] {
        fonts.load_font_source(fontdb::Source::Binary(Arc::new(font)));
    }
    Options {
        fontdb: Arc::new(fonts),
        ..Options::default()
    }
});

/// An SVG document as a PNG file of the given width and height in pixels, on white.
pub(super) fn png(svg: &str, (width, height): (u32, u32)) -> Result<Vec<u8>, ReportError> {
    let tree = Tree::from_str(svg, &OPTIONS).map_err(refused)?;
    let mut sheet = Pixmap::new(width, height).ok_or_else(|| refused("a sheet of no size"))?;
    sheet.fill(Color::WHITE);
    let scale = Transform::from_scale(
        width as f32 / tree.size().width(),
        height as f32 / tree.size().height(),
    );
    resvg::render(&tree, scale, &mut sheet.as_mut());
    sheet.encode_png().map_err(refused)
}

/// Opaque RGBA pixels, row by row, as a PNG file.
pub(super) fn encode(pixels: Vec<u8>, (width, height): (u32, u32)) -> Result<Vec<u8>, ReportError> {
    IntSize::from_wh(width, height)
        .and_then(|size| Pixmap::from_vec(pixels, size))
        .ok_or_else(|| refused("a picture whose size is not that of its pixels"))?
        .encode_png()
        .map_err(refused)
}

/// Width of a line of text in units of its size (em); 0 for what cannot be set.
pub(super) fn text_width(text: &str, is_bold: bool) -> f64 {
    const SIZE: f64 = 1000.0;
    let weight = if is_bold { "bold" } else { "normal" };
    let svg = maud::html! {
        svg xmlns="http://www.w3.org/2000/svg" width="1" height="1" {
            text xml:space="preserve" font-family=(FAMILY) font-size=(SIZE) font-weight=(weight) {
                (marked(text))
            }
        }
    };
    let Ok(tree) = Tree::from_str(&with_tags(&svg.into_string()), &OPTIONS) else {
        return 0.0;
    };
    match tree.root().children() {
        [Node::Text(line)] => f64::from(line.bounding_box().width()) / SIZE,
        _ => 0.0,
    }
}

pub(super) fn refused(error: impl std::fmt::Display) -> ReportError {
    ReportError::Draw(error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sign_of_the_figures_is_in_both_fonts() {
        let faces: Vec<_> = OPTIONS.fontdb.faces().collect();
        assert_eq!(faces.len(), 2);
        assert!(faces.iter().all(|face| face.families[0].0 == "DejaVu Sans"));
        let missing = text_width("\u{4e00}", false);
        for is_bold in [false, true] {
            for character in "aZ09θβαγεκσ₀₁₉ₘₐₓ°±−–…×²³⁰⁻⁹∩≥é§".chars()
            {
                let width = text_width(&character.to_string(), is_bold);
                assert!(width > 0.2 && width != missing, "{character}: {width}");
            }
        }
    }

    #[test]
    fn widths_are_those_of_the_font() {
        assert_eq!(text_width("", false), 0.0);
        // Digits of DejaVu Sans are 1303 of 2048 units wide.
        assert!((text_width("0", false) - 1303.0 / 2048.0).abs() < 1e-4);
        assert!((text_width("00", false) - 2.0 * text_width("0", false)).abs() < 1e-4);
        assert!(text_width("joint", true) > text_width("joint", false));
        let parts = text_width("W", false) + 0.72 * text_width("F", false);
        assert!((text_width("W_F", false) - parts).abs() < 1e-4);
        assert!(text_width("a ", false) > text_width("a", false) + 0.3);
        assert!(text_width("<\u{0}&", false) > 1.5);
    }

    #[test]
    fn pictures_keep_their_pixels() {
        let pixels = [[200, 10, 0, 255], [0, 90, 255, 255]].concat();
        let png = encode(pixels.clone(), (2, 1)).unwrap();
        assert_eq!(Pixmap::decode_png(&png).unwrap().data(), pixels);
        assert!(encode(pixels, (3, 1)).is_err());
    }

    #[test]
    fn letters_of_both_weights_are_drawn() {
        let dark = |weight: &str| {
            let svg = format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100\" height=\"50\">\
                 <text y=\"40\" font-size=\"40\" font-family=\"{FAMILY}\" {weight}>joint</text></svg>"
            );
            let picture = Pixmap::decode_png(&png(&svg, (200, 100)).unwrap()).unwrap();
            picture.pixels().iter().filter(|p| p.red() < 128).count()
        };
        let [normal, bold] = [dark(""), dark("font-weight=\"bold\"")];
        assert!(normal > 1000 && bold > normal * 5 / 4, "{normal} {bold}");
    }

    #[test]
    fn a_broken_document_is_refused() {
        assert!(png("<svg", (10, 10)).is_err());
    }
}
