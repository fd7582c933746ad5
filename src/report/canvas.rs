//! The sheet to draw on: the only file that talks to plotters. Drawings are written as SVG; a PNG
//! is a rendering of that.
//!
//! Coordinates are printed points (1/72 inch of the finished figure), x to the right and y down.
//! A drawing may go on after an error; the first error comes out of [`Canvas::finish`].

use super::error::ReportError;
use super::render::{self, FAMILY, refused};
use super::subscript::{marked, with_tags};
use base64::{Engine, engine::general_purpose::STANDARD};
use plotters::prelude::{Color, DrawingBackend, FontTransform, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontDesc, FontFamily, FontStyle, RGBAColor, ShapeStyle, TextStyle};
use rayon::prelude::*;

/// Units of the drawing per printed point: 3200 units for a column of 8.5 cm. A PNG has half as
/// many pixels.
const UNITS_PER_POINT: f64 = 3200.0 / 241.0;

/// A point of the sheet, or of the plane that is drawn: x and y.
pub(super) type Point = [f64; 2];

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

/// The sheet a [`Figure`](super::Figure) draws on.
pub struct Canvas<'a> {
    sheet: SVGBackend<'a>,
    images: Vec<String>,
    error: Option<ReportError>,
}

/// Draws and returns a PNG file's bytes.
pub(super) fn png(size: Size, draw: impl FnOnce(&mut Canvas)) -> Result<Vec<u8>, ReportError> {
    png_of(&svg(size, draw)?, size)
}

/// The PNG file's bytes of what [`svg`] has drawn.
pub(super) fn png_of(document: &str, size: Size) -> Result<Vec<u8>, ReportError> {
    let (width, height) = size.units();
    render::png(document, (width / 2, height / 2))
}

/// Draws and returns the SVG document.
pub(super) fn svg(size: Size, draw: impl FnOnce(&mut Canvas)) -> Result<String, ReportError> {
    let (width, height) = size.units();
    let mut document = String::new();
    let images =
        Canvas::new(SVGBackend::with_string(&mut document, (width, height))).finish(draw)?;
    let document = insert_images(&with_tags(&document), &images);
    let root = format!("<svg width=\"{width}\" height=\"{height}\"");
    let page = format!(
        "<svg width=\"{}\" height=\"{}\" stroke-linejoin=\"round\" stroke-linecap=\"round\"",
        f64::from(width) / 4.0,
        f64::from(height) / 4.0
    );
    let family = "font-family=\"sans-serif\"";
    Ok(document
        .replacen(&root, &page, 1)
        .replace(family, &format!("font-family=\"{FAMILY}\"")))
}

/// Puts the prepared image elements in the place of single pixels, the only rectangles of a
/// document. plotters' own images have an address without a valid media type and padding.
fn insert_images(document: &str, images: &[String]) -> String {
    let mut parts = document.split("<rect ");
    let mut out = parts.next().unwrap_or_default().to_string();
    for (image, part) in images.iter().zip(parts) {
        out.push_str(image);
        out.push_str(part.split_once("/>").map_or("", |(_, rest)| rest));
    }
    out
}

impl<'a> Canvas<'a> {
    fn new(sheet: SVGBackend<'a>) -> Canvas<'a> {
        Canvas {
            sheet,
            images: Vec::new(),
            error: None,
        }
    }

    /// Runs the drawing on a white sheet and closes it.
    fn finish(mut self, draw: impl FnOnce(&mut Canvas)) -> Result<Vec<String>, ReportError> {
        let (width, height) = self.sheet.get_size();
        let corner = [width, height].map(|units| f64::from(units) / UNITS_PER_POINT);
        let sheet = [[0.0, 0.0], [corner[0], 0.0], corner, [0.0, corner[1]]];
        self.fill(&sheet, plotters::style::WHITE.to_rgba());
        draw(&mut self);
        let closed = self.sheet.present();
        self.note(closed);
        self.error.map_or(Ok(self.images), Err)
    }

    fn note(&mut self, outcome: Result<(), impl std::fmt::Display>) {
        if let (Err(error), None) = (outcome, &self.error) {
            self.error = Some(refused(error));
        }
    }

    /// Fills the polygon through `points`; points that are not finite are left out.
    pub(super) fn fill(&mut self, points: &[Point], colour: RGBAColor) {
        let style = ShapeStyle::from(&colour).filled();
        let outcome = self.sheet.fill_polygon(units(points), &style);
        self.note(outcome);
    }

    /// Draws an open line of the given width (points) through `points`.
    pub(super) fn stroke(&mut self, points: &[Point], width: f64, colour: RGBAColor) {
        let width = (width * UNITS_PER_POINT).round().max(1.0) as u32;
        let style = ShapeStyle::from(&colour).stroke_width(width);
        let outcome = self.sheet.draw_path(units(points), &style);
        self.note(outcome);
    }

    /// Draws a closed line through `points`.
    pub(super) fn outline(&mut self, points: &[Point], width: f64, colour: RGBAColor) {
        let closed: Vec<Point> = points.iter().chain(points.first()).copied().collect();
        self.stroke(&closed, width, colour);
    }

    /// A disc of `radius` points.
    pub(super) fn disc(&mut self, centre: Point, radius: f64, colour: RGBAColor) {
        if let Some(&centre) = units(&[centre]).first() {
            let radius = (radius * UNITS_PER_POINT).round() as u32;
            let style = ShapeStyle::from(&colour).filled();
            let outcome = self.sheet.draw_circle(centre, radius, &style, true);
            self.note(outcome);
        }
    }

    /// Writes `text`, where "W_F" stands for W with an index, with its base line starting, centred or ending at `at`.
    pub(super) fn text(&mut self, text: &str, at: Point, lettering: &Lettering) {
        let em = lettering.size * UNITS_PER_POINT;
        // plotters hangs texts from a point 0.76 em above the base line, calls 1.24 em their size.
        let rise = 0.76 * lettering.size;
        let (hook, transform) = if lettering.upright {
            ([at[0] - rise, at[1]], FontTransform::Rotate270)
        } else {
            ([at[0], at[1] - rise], FontTransform::None)
        };
        let (false, Some(&hook)) = (text.is_empty(), units(&[hook]).first()) else {
            return;
        };
        let weight = if lettering.bold {
            FontStyle::Bold
        } else {
            FontStyle::Normal
        };
        let font = FontDesc::new(FontFamily::SansSerif, 1.24 * em, weight);
        let style = TextStyle::from(font.transform(transform))
            .color(&lettering.colour)
            .pos(Pos::new(lettering.align, VPos::Top));
        let outcome = self.sheet.draw_text(&marked(text), &style, hook);
        self.note(outcome);
    }

    /// Places a picture with the pixels of the PNG: `colour(x, y)` gives the RGB colour at a point
    /// of the rectangle from `corner` over `size` points.
    pub(super) fn picture(
        &mut self,
        corner: Point,
        size: Point,
        colour: impl Fn(f64, f64) -> [u8; 3] + Sync,
    ) {
        let start = corner.map(|c| 2.0 * (0.5 * c * UNITS_PER_POINT).round().max(0.0));
        let [width, height] =
            size.map(|s| (0.5 * s * UNITS_PER_POINT).round().clamp(1.0, 4e3) as u32);
        let pixel = |k: u32| {
            let unit = [
                start[0] + f64::from(2 * (k % width)),
                start[1] + f64::from(2 * (k / width)),
            ];
            mean_colour(unit, &colour)
        };
        let pixels: Vec<[u8; 4]> = (0..width * height).into_par_iter().map(pixel).collect();
        let pixels = pixels.into_flattened();
        let outcome = self.place(start, (width, height), pixels);
        if let (Err(error), None) = (outcome, &self.error) {
            self.error = Some(error);
        }
    }

    fn place(&mut self, at: Point, size: (u32, u32), pixels: Vec<u8>) -> Result<(), ReportError> {
        let data = STANDARD.encode(render::encode(pixels, size)?);
        self.images.push(format!(
            "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" \
             href=\"data:image/png;base64,{data}\"/>",
            at[0],
            at[1],
            2 * size.0,
            2 * size.1
        ));
        let corner = at.map(|c| c as i32).into();
        let mark = plotters::style::BLACK.to_backend_color();
        self.sheet.draw_pixel(corner, mark).map_err(refused)
    }
}

/// The mean of the colours of four units, opaque; `unit` is the first one's corner.
fn mean_colour(unit: Point, colour: impl Fn(f64, f64) -> [u8; 3]) -> [u8; 4] {
    let mut sum = [0u16; 3];
    for (x, y) in [(0.5, 0.5), (1.5, 0.5), (0.5, 1.5), (1.5, 1.5)] {
        let at = [unit[0] + x, unit[1] + y].map(|c| c / UNITS_PER_POINT);
        let part = colour(at[0], at[1]);
        sum = std::array::from_fn(|k| sum[k] + u16::from(part[k]));
    }
    let [red, green, blue] = sum.map(|s| ((s + 2) / 4) as u8);
    [red, green, blue, 255]
}

/// Whole units of the finite points, without repeated ones.
fn units(points: &[Point]) -> Vec<(i32, i32)> {
    let finite = points.iter().filter(|p| p.iter().all(|c| c.is_finite()));
    let unit = |c: f64| (c * UNITS_PER_POINT).clamp(-1e5, 1e5).round() as i32;
    let mut out: Vec<(i32, i32)> = finite.map(|p| (unit(p[0]), unit(p[1]))).collect();
    out.dedup();
    out
}
