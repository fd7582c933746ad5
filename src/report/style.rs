//! Colours and sizes shared by all figures: Okabe and Ito's colours, safe for colour-blind
//! readers, and letters of at least 6 points in a column of 8.5 cm.

use plotters::style::RGBAColor;

const fn rgb(hex: u32) -> RGBAColor {
    RGBAColor((hex >> 16) as u8, (hex >> 8) as u8, hex as u8, 1.0)
}

pub(super) const INK: RGBAColor = rgb(0x22_22_22);
pub(super) const WHITE: RGBAColor = rgb(0xff_ff_ff);
pub(super) const GRID: RGBAColor = rgb(0xdd_dd_dd);
pub(super) const PALE: RGBAColor = rgb(0xe8_e8_e8);
/// The unrestricted workspace of spatial tasks, a little darker than [`PALE`]: its maps are large.
pub(super) const REACHABLE: RGBAColor = rgb(0xdc_dc_dc);
pub(super) const GREY: RGBAColor = rgb(0x8c_8c_8c);
pub(super) const BLUE: RGBAColor = rgb(0x00_72_b2);
pub(super) const SKY: RGBAColor = rgb(0x56_b4_e9);
pub(super) const GREEN: RGBAColor = rgb(0x00_9e_73);
pub(super) const ORANGE: RGBAColor = rgb(0xe6_9f_00);
pub(super) const VERMILLION: RGBAColor = rgb(0xd5_5e_00);
pub(super) const PURPLE: RGBAColor = rgb(0xcc_79_a7);

/// The same colour, translucent.
pub(super) const fn translucent(colour: RGBAColor, alpha: f64) -> RGBAColor {
    RGBAColor(colour.0, colour.1, colour.2, alpha)
}

/// Width of a figure, points: one column of a paper.
pub(super) const COLUMN: f64 = 241.0;
/// Width of a figure across both columns of a paper, points (17.8 cm).
pub(super) const DOUBLE_COLUMN: f64 = 504.0;
/// Letters of tick labels and legends, points.
pub(super) const SMALL: f64 = 6.5;
/// Letters of axis labels, points.
pub(super) const NORMAL: f64 = 7.0;
/// Letters of titles, points.
pub(super) const TITLE: f64 = 7.5;
/// Free space at the outer edges, points; at least 25 pixels of the PNG.
pub(super) const MARGIN: f64 = 6.0;
/// From a line of letters' base line to the middle of its capitals, in units of its size.
pub(super) const HALF_CAPITAL: f64 = 0.36;
