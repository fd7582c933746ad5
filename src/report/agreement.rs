//! Axes for what was predicted against what is: equal ranges, a grid and the diagonal.

use super::canvas::Canvas;
use super::label::dashed;
use super::panel::Panel;
use super::style::GREY;
use super::ticks::Tick;

/// Draws grid, axes and the diagonal of a panel with the same range on both axes.
pub(super) fn draw(
    canvas: &mut Canvas,
    panel: &Panel,
    x_ticks: &[Tick],
    y_ticks: &[Tick],
    labels_left: bool,
) {
    panel.grid(canvas, y_ticks);
    panel.upright_grid(canvas, x_ticks);
    let [low, high] = panel.x.map(|value| panel.at(value, value));
    dashed(canvas, low, high, 0.8, GREY);
    panel.axes(canvas, x_ticks, y_ticks, labels_left);
}

/// A name of a surrogate as it is printed: an underscore would make an index of what follows it.
pub(super) fn spaced(name: &str) -> String {
    name.replace('_', " ")
}
