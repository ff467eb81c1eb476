//! Grouped bars.

use super::axis::Scale;
use super::colour::{Colour, FRAME, INK, category};
use super::drawing::{Anchor, Area, Drawing, Text};
use super::frame::Corner;
use super::frame::{self, Key, LABEL, SMALL};
use super::render::text_width;

/// Bars of one colour, one for each category.
#[derive(Debug, Clone)]
pub struct BarGroup {
    /// Name for the legend.
    pub name: String,
    /// Height in each category; `None` leaves a gap.
    pub values: Vec<Option<f64>>,
    /// Half length of the error bar in each category; empty for none.
    pub errors: Vec<f64>,
}

/// Grouped bars over categories.
#[derive(Debug, Clone)]
pub struct Bars {
    title: String,
    label: String,
    y: Scale,
    categories: Vec<String>,
    groups: Vec<BarGroup>,
    legend: Corner,
}

impl Bars {
    /// Bars without groups; `label` names the categories' axis. The value axis starts at zero
    /// unless it is logarithmic.
    pub fn new(
        title: impl Into<String>,
        label: impl Into<String>,
        y: Scale,
        categories: Vec<String>,
    ) -> Self {
        Self {
            title: title.into(),
            label: label.into(),
            y: y.from_zero(),
            categories,
            groups: Vec::new(),
            legend: Corner::Above,
        }
    }

    /// Adds a group.
    pub fn group(mut self, name: impl Into<String>, values: Vec<Option<f64>>) -> Self {
        self.groups.push(BarGroup {
            name: name.into(),
            values,
            errors: Vec::new(),
        });
        self
    }

    /// Adds a group with error bars.
    pub fn group_with_errors(mut self, group: BarGroup) -> Self {
        self.groups.push(group);
        self
    }

    /// Places the legend.
    pub fn legend(mut self, corner: Corner) -> Self {
        self.legend = corner;
        self
    }

    pub(super) fn draw(&self, out: &mut Drawing, area: Area) {
        let area = frame::title(out, area, &self.title);
        let entries: Vec<(Key, Colour, &str)> = self
            .groups
            .iter()
            .enumerate()
            .map(|(g, group)| (Key::Square, category(g), group.name.as_str()))
            .collect();
        let area = frame::legend_above(out, area, self.legend, &entries);
        let tops = self.groups.iter().flat_map(|g| {
            let error = |i: usize| g.errors.get(i).copied().unwrap_or(0.0);
            g.values
                .iter()
                .enumerate()
                .filter_map(move |(i, v)| v.map(|v| v + error(i)))
        });
        let y = self.y.fit(tops);
        let widest = y
            .ticks()
            .map(|(_, t)| text_width(t, SMALL))
            .fold(0.0, f64::max);
        let slot = (area.width - widest - 56.0) / self.categories.len().max(1) as f64;
        let longest = self
            .categories
            .iter()
            .map(|c| text_width(c, SMALL))
            .fold(0.0, f64::max);
        // Names that do not fit side by side stand upright.
        let upright = longest > slot - 4.0;
        let foot = if upright { longest + 34.0 } else { 46.0 };
        let plot = area.inside(widest + 34.0, 0.0, 22.0, foot);
        frame::y_ticks(out, plot, &y, self.y.label());
        let share = 0.8 / self.groups.len().max(1) as f64;
        for (c, name) in self.categories.iter().enumerate() {
            let left = plot.x + c as f64 * slot;
            for (g, group) in self.groups.iter().enumerate() {
                let Some(value) = group.values.get(c).copied().flatten() else {
                    continue;
                };
                let Some(top) = y.place(value) else { continue };
                let base = y.place(0.0).unwrap_or(0.0);
                let height = (top - base) * plot.height;
                let bar = Area {
                    x: left + slot * (0.1 + g as f64 * share),
                    y: plot.bottom() - base * plot.height - height.max(0.0),
                    width: (slot * share - 1.0).max(1.0),
                    height: height.abs(),
                };
                out.rect(bar, category(g));
                self.error_bar(out, plot, bar, (value, group.errors.get(c)), &y);
            }
            let at = (left + slot / 2.0, plot.bottom() + 13.0);
            match upright {
                false => out.text(at, name, SMALL, Anchor::Middle),
                true => out.label(Text {
                    at: (at.0, plot.bottom() + 6.0),
                    text: name.clone(),
                    size: SMALL,
                    anchor: Anchor::End,
                    colour: INK,
                    bold: false,
                    vertical: true,
                }),
            }
        }
        let middle = (plot.x + plot.width / 2.0, plot.bottom() + foot - 13.0);
        out.text(middle, &self.label, LABEL, Anchor::Middle);
        out.outline(plot, 1.0, FRAME);
        frame::legend(out, plot, self.legend, &entries);
    }

    fn error_bar(
        &self,
        out: &mut Drawing,
        plot: Area,
        bar: Area,
        (value, error): (f64, Option<&f64>),
        y: &super::axis::Fitted,
    ) {
        let Some(&error) = error else { return };
        if let (Some(low), Some(high)) = (y.place(value - error), y.place(value + error)) {
            let x = bar.x + bar.width / 2.0;
            let at = |p: f64| plot.bottom() - p * plot.height;
            out.path(vec![(x, at(low)), (x, at(high))], 1.2, INK);
        }
    }
}
