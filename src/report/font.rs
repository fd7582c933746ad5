//! The embedded font, so that no figure depends on the fonts of the machine.
//!
//! Letters of bitmaps are filled as outlines: plotters' own text drops the side bearings of
//! letters and rounds their places to whole pixels, which makes words look uneven.

use super::raster::Point;
use ab_glyph::{Font, FontRef, GlyphId, OutlineCurve};
use std::sync::OnceLock;

static NORMAL: &[u8] = include_bytes!("../../assets/DejaVuSans-sub.ttf");
static BOLD: &[u8] = include_bytes!("../../assets/DejaVuSans-Bold-sub.ttf");

/// What an SVG asks for: the same font, or Verdana of the same metrics.
pub(super) const SVG_FAMILY: &str = "DejaVu Sans, Verdana, sans-serif";

/// Straight pieces per curved piece of an outline.
const PIECES: usize = 5;

/// Width of `text` in units of its size (em); 0 if the font is damaged.
pub(super) fn width(text: &str, is_bold: bool) -> f64 {
    let Some(face) = face(is_bold) else {
        return 0.0;
    };
    placed(face, text).last().map_or(0.0, |glyph| glyph.end)
}

/// Closed contours of `text`, in units of its size: from the start of the base line, x to the
/// right and y down, to be filled by the non-zero rule.
pub(super) fn contours(text: &str, is_bold: bool) -> Vec<Vec<Point>> {
    let Some(face) = face(is_bold) else {
        return Vec::new();
    };
    let em = units_per_em(face);
    let mut contours: Vec<Vec<Point>> = Vec::new();
    for glyph in placed(face, text) {
        let Some(outline) = face.outline(glyph.id) else {
            continue;
        };
        let mut pen = None;
        for curve in outline.curves {
            let corners = corners(curve);
            let place = |p: &Point| [glyph.start + p[0] / em, -p[1] / em];
            if pen != Some(corners[0]) {
                contours.push(vec![place(&corners[0])]);
            }
            pen = corners.last().copied();
            if let Some(contour) = contours.last_mut() {
                contour.extend(corners[1..].iter().map(place));
            }
        }
    }
    contours
}

struct Placed {
    id: GlyphId,
    start: f64,
    end: f64,
}

/// The glyphs of a line of text, kerned, in units of the size.
fn placed(face: &FontRef, text: &str) -> Vec<Placed> {
    let em = units_per_em(face);
    let mut line: Vec<Placed> = Vec::new();
    for character in text.chars() {
        let id = face.glyph_id(character);
        let start = line.last().map_or(0.0, |previous| {
            previous.end + f64::from(face.kern_unscaled(previous.id, id)) / em
        });
        let end = start + f64::from(face.h_advance_unscaled(id)) / em;
        line.push(Placed { id, start, end });
    }
    line
}

fn corners(curve: OutlineCurve) -> Vec<Point> {
    let points: Vec<Point> = match curve {
        OutlineCurve::Line(a, b) => vec![a, b],
        OutlineCurve::Quad(a, b, c) => vec![a, b, c],
        OutlineCurve::Cubic(a, b, c, d) => vec![a, b, c, d],
    }
    .into_iter()
    .map(|p| [f64::from(p.x), f64::from(p.y)])
    .collect();
    if points.len() == 2 {
        return points;
    }
    (0..=PIECES)
        .map(|k| on_curve(&points, k as f64 / PIECES as f64))
        .collect()
}

/// The point of a Bézier curve at `t` in [0, 1], by de Casteljau's algorithm.
fn on_curve(points: &[Point], t: f64) -> Point {
    let mut points = points.to_vec();
    while points.len() > 1 {
        let between = |pair: &[Point]| {
            let mix = |axis: usize| (1.0 - t) * pair[0][axis] + t * pair[1][axis];
            [mix(0), mix(1)]
        };
        points = points.windows(2).map(between).collect();
    }
    points[0]
}

fn units_per_em(face: &FontRef) -> f64 {
    face.units_per_em().map_or(2048.0, f64::from)
}

fn face(is_bold: bool) -> Option<&'static FontRef<'static>> {
    static FACES: OnceLock<[Option<FontRef<'static>>; 2]> = OnceLock::new();
    let faces =
        FACES.get_or_init(|| [NORMAL, BOLD].map(|bytes| FontRef::try_from_slice(bytes).ok()));
    faces[usize::from(is_bold)].as_ref()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sign_of_the_figures_is_in_the_font() {
        for is_bold in [false, true] {
            let face = face(is_bold).unwrap();
            for character in "aZ09θ₀₁₉ₘₐₓ°±−–…×²³⁰⁻⁹∩≥é§".chars()
            {
                assert_ne!(face.glyph_id(character).0, 0, "{character}");
            }
        }
    }

    #[test]
    fn widths_add_up_and_contours_stay_inside() {
        assert_eq!(width("", false), 0.0);
        assert!((width("00", false) - 2.0 * width("0", false)).abs() < 1e-6);
        assert!(width("joint", true) > width("joint", false));
        let corners = contours("joint 1", false).concat();
        let right = width("joint 1", false);
        assert!(corners.iter().all(|p| p[0] > -0.1 && p[0] < right + 0.1));
        assert!(corners.iter().all(|p| p[1] < 0.3 && p[1] > -1.0));
    }
}
