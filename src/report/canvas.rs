//! One sheet to draw on, kept as a bitmap or as SVG: the only file that talks to plotters.
//!
//! Coordinates are printed points (1/72 inch of the finished figure), x to the right and y down.
//! A drawing may go on after an error; the first error comes out of [`Canvas::finish`].

use super::error::ReportError;
use super::font::{self, SVG_FAMILY};
use super::png::{encode, halve};
use super::raster::{self, Point};
use base64::{Engine, engine::general_purpose::STANDARD};
use plotters::prelude::{BitMapBackend, Color, DrawingBackend, FontTransform, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontDesc, FontFamily, FontStyle, RGBAColor, ShapeStyle, TextStyle};

/// Units of the drawing per printed point: 3200 units for a column of 8.5 cm. A PNG has half as
/// many pixels.
const UNITS_PER_POINT: f64 = 3200.0 / 241.0;

/// A figure's size when printed, in points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    /// Width in points; a column of a paper has 241 (8.5 cm).
    pub width: f64,
    /// Height in points.
    pub height: f64,
}

impl Size {
    /// Size in drawing units, even numbers.
    fn units(self) -> (u32, u32) {
        let even =
            |points: f64| 2 * (points * UNITS_PER_POINT / 2.0).round().clamp(1.0, 8e3) as u32;
        (even(self.width), even(self.height))
    }
}

/// How a text sits at its point.
#[derive(Clone, Copy)]
pub(super) struct Lettering {
    /// Height of the letters' em square in points.
    pub size: f64,
    pub bold: bool,
    pub colour: RGBAColor,
    pub align: HPos,
    /// Read from bottom to top.
    pub upright: bool,
}

enum Sheet<'a> {
    Bitmap(BitMapBackend<'a>),
    Svg(SVGBackend<'a>),
}

/// The sheet a [`Figure`](super::Figure) draws on.
pub struct Canvas<'a> {
    sheet: Sheet<'a>,
    images: Vec<String>,
    error: Option<ReportError>,
}

/// Draws on a bitmap and returns it as a PNG file's bytes.
pub(super) fn png(size: Size, draw: impl FnOnce(&mut Canvas)) -> Result<Vec<u8>, ReportError> {
    let (pixels, width, height) = pixels(size, draw)?;
    encode(&pixels, (width, height))
}

/// Draws on a bitmap and returns its RGB pixels, row by row, with width and height.
pub(super) fn pixels(
    size: Size,
    draw: impl FnOnce(&mut Canvas),
) -> Result<(Vec<u8>, u32, u32), ReportError> {
    let (width, height) = size.units();
    let mut pixels = vec![255; 3 * (width * height) as usize];
    let backend = BitMapBackend::with_buffer(&mut pixels, (width, height));
    Canvas::new(Sheet::Bitmap(backend)).finish(draw)?;
    Ok((halve(&pixels, width, height), width / 2, height / 2))
}

/// Draws as SVG and returns the document.
pub(super) fn svg(size: Size, draw: impl FnOnce(&mut Canvas)) -> Result<String, ReportError> {
    let (width, height) = size.units();
    let mut document = String::new();
    let backend = SVGBackend::with_string(&mut document, (width, height));
    let images = Canvas::new(Sheet::Svg(backend)).finish(draw)?;
    let document = insert_images(&document, &images);
    let root = format!("<svg width=\"{width}\" height=\"{height}\"");
    let page = format!(
        "<svg width=\"{}\" height=\"{}\" stroke-linejoin=\"round\" stroke-linecap=\"round\"",
        width / 4,
        height / 4
    );
    let family = "font-family=\"sans-serif\"";
    Ok(document
        .replacen(&root, &page, 1)
        .replace(family, &format!("font-family=\"{SVG_FAMILY}\"")))
}

/// Puts the prepared image elements in the place of plotters' own, whose address lacks a valid
/// media type and padding.
fn insert_images(document: &str, images: &[String]) -> String {
    let mut parts = document.split("<image ");
    let mut out = parts.next().unwrap_or_default().to_string();
    for (k, part) in parts.enumerate() {
        let rest = part.split_once("/>").map_or("", |(_, rest)| rest);
        out.push_str(images.get(k).map_or("", String::as_str));
        out.push_str(rest);
    }
    out
}

impl<'a> Canvas<'a> {
    fn new(sheet: Sheet<'a>) -> Canvas<'a> {
        Canvas {
            sheet,
            images: Vec::new(),
            error: None,
        }
    }

    /// Runs the drawing on a white sheet and closes it.
    fn finish(mut self, draw: impl FnOnce(&mut Canvas)) -> Result<Vec<String>, ReportError> {
        let (width, height) = match &self.sheet {
            Sheet::Bitmap(backend) => backend.get_size(),
            Sheet::Svg(backend) => backend.get_size(),
        };
        let corner = [width, height].map(|units| f64::from(units) / UNITS_PER_POINT);
        let sheet = [[0.0, 0.0], [corner[0], 0.0], corner, [0.0, corner[1]]];
        self.fill(&sheet, plotters::style::WHITE.to_rgba());
        draw(&mut self);
        let closed = match &mut self.sheet {
            Sheet::Bitmap(backend) => backend.present().map_err(refused),
            Sheet::Svg(backend) => backend.present().map_err(refused),
        };
        self.note(closed);
        self.error.map_or(Ok(self.images), Err)
    }

    fn note(&mut self, outcome: Result<(), ReportError>) {
        if let (Err(error), None) = (outcome, &self.error) {
            self.error = Some(error);
        }
    }

    /// Fills the polygon through `points`; points that are not finite are left out.
    pub(super) fn fill(&mut self, points: &[Point], colour: RGBAColor) {
        let points = units(points);
        let outcome = match &mut self.sheet {
            Sheet::Bitmap(backend) => paint(backend, &[points], colour),
            Sheet::Svg(backend) => {
                let style = ShapeStyle::from(&colour).filled();
                backend
                    .fill_polygon(whole(&points), &style)
                    .map_err(refused)
            }
        };
        self.note(outcome);
    }

    /// Draws an open line of the given width (points) through `points`.
    pub(super) fn stroke(&mut self, points: &[Point], width: f64, colour: RGBAColor) {
        let points = units(points);
        let width = (width * UNITS_PER_POINT).max(1.0);
        let outcome = match &mut self.sheet {
            Sheet::Bitmap(backend) => paint(backend, &raster::stroke(&points, width), colour),
            Sheet::Svg(backend) => {
                let style = ShapeStyle::from(&colour).stroke_width(width.round() as u32);
                backend.draw_path(whole(&points), &style).map_err(refused)
            }
        };
        self.note(outcome);
    }

    /// Draws a closed line through `points`.
    pub(super) fn outline(&mut self, points: &[Point], width: f64, colour: RGBAColor) {
        let closed: Vec<Point> = points.iter().chain(points.first()).copied().collect();
        self.stroke(&closed, width, colour);
    }

    /// A disc of `radius` points.
    pub(super) fn disc(&mut self, centre: Point, radius: f64, colour: RGBAColor) {
        let Some(&centre) = units(&[centre]).first() else {
            return;
        };
        let radius = radius * UNITS_PER_POINT;
        let outcome = match &mut self.sheet {
            Sheet::Bitmap(backend) => paint(backend, &[raster::disc(centre, radius)], colour),
            Sheet::Svg(backend) => {
                let (style, at) = (ShapeStyle::from(&colour).filled(), whole(&[centre])[0]);
                backend
                    .draw_circle(at, radius.round() as u32, &style, true)
                    .map_err(refused)
            }
        };
        self.note(outcome);
    }

    /// Writes `text` with its base line starting, centred or ending at `at`.
    pub(super) fn text(&mut self, text: &str, at: Point, lettering: &Lettering) {
        if text.is_empty() || !(at[0].is_finite() && at[1].is_finite()) {
            return;
        }
        let outcome = match &mut self.sheet {
            Sheet::Bitmap(backend) => {
                let contours = letters(text, at, lettering);
                paint(backend, &contours, lettering.colour)
            }
            Sheet::Svg(backend) => write(backend, text, at, lettering),
        };
        self.note(outcome);
    }

    /// Places a square-pixelled picture: `colour(x, y)` gives the RGB colour at a point of the
    /// rectangle from `corner` over `size` points.
    pub(super) fn picture(
        &mut self,
        corner: Point,
        size: Point,
        colour: impl Fn(f64, f64) -> [u8; 3],
    ) {
        // Bitmaps are halved afterwards, so both kinds end up at the same resolution.
        let step = if matches!(self.sheet, Sheet::Svg(_)) {
            2.0
        } else {
            1.0
        };
        let at = corner.map(|c| (c * UNITS_PER_POINT).round().max(0.0));
        let extent = size.map(|s| (s * UNITS_PER_POINT / step).round().clamp(1.0, 8e3) as u32);
        let place = |start: f64, k: u32| (start + (f64::from(k) + 0.5) * step) / UNITS_PER_POINT;
        let mut pixels = Vec::with_capacity(3 * (extent[0] * extent[1]) as usize);
        for row in 0..extent[1] {
            for column in 0..extent[0] {
                pixels.extend(colour(place(at[0], column), place(at[1], row)));
            }
        }
        let outcome = self.blit(at, extent, step, &pixels);
        self.note(outcome);
    }

    fn blit(
        &mut self,
        at: Point,
        extent: [u32; 2],
        step: f64,
        pixels: &[u8],
    ) -> Result<(), ReportError> {
        let corner = whole(&[at])[0];
        match &mut self.sheet {
            Sheet::Bitmap(backend) => {
                let (width, height) = backend.get_size();
                let inside = at[0] + f64::from(extent[0]) <= f64::from(width)
                    && at[1] + f64::from(extent[1]) <= f64::from(height);
                if !inside {
                    return Err(ReportError::Draw("a picture leaves its sheet".into()));
                }
                backend
                    .blit_bitmap(corner, (extent[0], extent[1]), pixels)
                    .map_err(refused)
            }
            Sheet::Svg(backend) => {
                let data = STANDARD.encode(encode(pixels, (extent[0], extent[1]))?);
                self.images.push(format!(
                    "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" \
                     href=\"data:image/png;base64,{data}\"/>",
                    corner.0,
                    corner.1,
                    f64::from(extent[0]) * step,
                    f64::from(extent[1]) * step
                ));
                backend
                    .blit_bitmap(corner, (1, 1), &[255; 3])
                    .map_err(refused)
            }
        }
    }
}

fn refused(error: impl std::fmt::Display) -> ReportError {
    ReportError::Draw(error.to_string())
}

/// The outlines of a line of text, in units.
fn letters(text: &str, at: Point, lettering: &Lettering) -> Vec<Vec<Point>> {
    let size = lettering.size;
    let width = size * font::width(text, lettering.bold);
    let start = match lettering.align {
        HPos::Left => 0.0,
        HPos::Center => -0.5 * width,
        HPos::Right => -width,
    };
    let place = |p: &Point| {
        let (along, down) = (start + size * p[0], size * p[1]);
        let point = if lettering.upright {
            [at[0] + down, at[1] - along]
        } else {
            [at[0] + along, at[1] + down]
        };
        point.map(|c| c * UNITS_PER_POINT)
    };
    let contours = font::contours(text, lettering.bold);
    contours
        .iter()
        .map(|c| c.iter().map(place).collect())
        .collect()
}

/// Writes a line of text into an SVG.
fn write(
    backend: &mut SVGBackend,
    text: &str,
    at: Point,
    lettering: &Lettering,
) -> Result<(), ReportError> {
    let em = lettering.size * UNITS_PER_POINT;
    let mut at = at.map(|c| c * UNITS_PER_POINT);
    // plotters hangs texts from a point 0.76 em above the base line, and calls 1.24 em their size.
    at[if lettering.upright { 0 } else { 1 }] -= 0.76 * em;
    let weight = if lettering.bold {
        FontStyle::Bold
    } else {
        FontStyle::Normal
    };
    let transform = if lettering.upright {
        FontTransform::Rotate270
    } else {
        FontTransform::None
    };
    let font = FontDesc::new(FontFamily::SansSerif, 1.24 * em, weight);
    let style = TextStyle::from(font.transform(transform))
        .color(&lettering.colour)
        .pos(Pos::new(lettering.align, VPos::Top));
    backend
        .draw_text(text, &style, whole(&[at])[0])
        .map_err(refused)
}

fn units(points: &[Point]) -> Vec<Point> {
    let finite = points
        .iter()
        .filter(|p| p[0].is_finite() && p[1].is_finite());
    finite
        .map(|p| p.map(|c| (c * UNITS_PER_POINT).clamp(-1e5, 1e5)))
        .collect()
}

/// Whole units, without repeated points.
fn whole(points: &[Point]) -> Vec<(i32, i32)> {
    let mut out: Vec<(i32, i32)> = points
        .iter()
        .map(|p| (p[0].round() as i32, p[1].round() as i32))
        .collect();
    out.dedup();
    out
}

fn paint(
    backend: &mut BitMapBackend,
    contours: &[Vec<Point>],
    colour: RGBAColor,
) -> Result<(), ReportError> {
    let mut outcome = Ok(());
    raster::fill(contours, backend.get_size(), |x, y, length, coverage| {
        let colour = colour.mix(coverage);
        let run = if colour.3 >= 1.0 {
            // plotters' rectangles end before their lower right corner.
            backend.draw_rect((x, y), (x + length, y + 1), &colour, true)
        } else {
            let colour = colour.to_backend_color();
            (x..x + length).try_for_each(|x| backend.draw_pixel((x, y), colour))
        };
        if let (Err(error), true) = (run, outcome.is_ok()) {
            outcome = Err(refused(error));
        }
    });
    outcome
}
