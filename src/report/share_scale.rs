//! From a share to a colour, and the bar that tells which is which.

use super::canvas::{Canvas, Point};
use super::colour_bar::ColourBar;
use crate::workspace::SpatialShareMap;
use plotters::prelude::ViridisRGB;
use plotters::style::{Color, RGBAColor};

/// Colours of one kind of share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Palette {
    /// Shares of orientations.
    Viridis,
    /// Shares of cells and reachable shares, light to dark.
    Blues,
    /// Densities: blues that start from white.
    Density,
}

impl Palette {
    /// The palette of a map's fault-tolerant shares. Positions are tolerant or not, and blue as in
    /// the planar figure.
    pub(super) fn of(map: &SpatialShareMap) -> Palette {
        match map.orientations {
            true => Palette::Viridis,
            false => Palette::Blues,
        }
    }

    /// The colour at a level in [0, 1].
    pub(super) fn colour(self, level: f64) -> RGBAColor {
        match self {
            Palette::Viridis => ViridisRGB::get_color(level).to_rgba(),
            Palette::Blues => blue(&BLUES[1..], level),
            Palette::Density => blue(&BLUES, level),
        }
    }
}

/// Shares from 0 to `top` as colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ShareScale {
    pub top: f64,
    pub palette: Palette,
}

/// Colours of [`Palette::Density`] at equal distances; [`Palette::Blues`] starts from the second.
const BLUES: [[f64; 3]; 5] = [
    [255.0, 255.0, 255.0],
    [200.0, 224.0, 242.0],
    [115.0, 183.0, 226.0],
    [20.0, 115.0, 180.0],
    [5.0, 45.0, 90.0],
];

impl ShareScale {
    /// Viridis up to 100 %.
    pub(super) const FULL: ShareScale = ShareScale {
        top: 1.0,
        palette: Palette::Viridis,
    };

    /// The scale up to a round percentage that just holds `most`: small workspaces would be of
    /// one colour on a scale of 100 %.
    pub(super) fn fitting(most: f64, palette: Palette) -> ShareScale {
        let tops = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0];
        let holds = |top: &f64| most > 0.0 && most <= *top * (1.0 + 1e-6);
        let top = tops.into_iter().find(holds).unwrap_or(1.0);
        ShareScale { top, palette }
    }

    pub(super) fn colour(&self, share: f64) -> RGBAColor {
        self.palette.colour((share / self.top).clamp(0.0, 1.0))
    }

    /// Space that a bar needs right of its corner, points, its label included.
    pub(super) fn bar_width(&self) -> f64 {
        self.bar().width()
    }

    /// The bar in percent.
    fn bar(&self) -> ColourBar {
        ColourBar::new(100.0 * self.top, self.palette)
    }

    /// Draws the bar with its left upper corner at (x, y), `text` beside it.
    pub(super) fn draw_bar(&self, canvas: &mut Canvas, corner: Point, height: f64, text: &str) {
        self.bar().draw(canvas, corner, height, text);
    }
}

fn blue(colours: &[[f64; 3]], level: f64) -> RGBAColor {
    let at = level * (colours.len() - 1) as f64;
    let k = (at as usize).min(colours.len() - 2);
    let t = at - k as f64;
    let [red, green, blue] =
        std::array::from_fn(|c| (colours[k][c] + t * (colours[k + 1][c] - colours[k][c])) as u8);
    RGBAColor(red, green, blue, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_top_is_round_and_holds_the_most() {
        let top = |most| ShareScale::fitting(most, Palette::Viridis).top;
        assert_eq!(
            [0.6, 0.5, 0.03, 0.0, 1e-9].map(top),
            [1.0, 0.5, 0.05, 1.0, 0.001]
        );
        assert_eq!(top(f64::NAN), 1.0);
    }

    #[test]
    fn colours_get_darker_or_lighter_all_the_way() {
        let light = |palette, share: f64| {
            let colour = ShareScale { top: 0.5, palette }.colour(share);
            u32::from(colour.0) + 2 * u32::from(colour.1) + u32::from(colour.2)
        };
        let shares = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5];
        let viridis = shares.map(|s| light(Palette::Viridis, s));
        let blues = shares.map(|s| light(Palette::Blues, s));
        assert!(viridis.windows(2).all(|pair| pair[0] < pair[1]));
        assert!(blues.windows(2).all(|pair| pair[0] > pair[1]));
        assert_eq!(light(Palette::Blues, 7.0), blues[5]);
    }
}
