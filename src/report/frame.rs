//! The frame of a chart: grid, ticks, labels, title, legend.

use super::axis::{Fitted, Scale};
use super::colour::{Colour, FRAME, GRID, INK, MUTED, PAPER};
use super::drawing::{Anchor, Area, Drawing, Text};
use super::render::text_width;

/// The corner of the chart in which the legend stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Corner {
    /// Upper right.
    #[default]
    TopRight,
    /// Upper left.
    TopLeft,
    /// Lower right.
    BottomRight,
    /// Lower left.
    BottomLeft,
    /// In rows above the plot, where it covers nothing.
    Above,
    /// No legend.
    None,
}

/// Height of tick labels and legends.
pub(crate) const SMALL: f64 = 11.5;
/// Height of axis labels.
pub(crate) const LABEL: f64 = 12.5;
/// Height of panel titles.
pub(crate) const TITLE: f64 = 14.0;

/// Draws the title and gives back the area below it.
pub(crate) fn title(out: &mut Drawing, area: Area, text: &str) -> Area {
    if text.is_empty() {
        return area.inside(0.0, 6.0, 0.0, 0.0);
    }
    out.label(Text {
        at: (area.x + area.width / 2.0, area.y + 13.0),
        text: text.to_string(),
        size: TITLE,
        anchor: Anchor::Middle,
        colour: INK,
        bold: true,
        vertical: false,
    });
    area.inside(0.0, 30.0, 0.0, 0.0)
}

/// Draws grid, ticks and labels of both axes; gives back the plotting area.
pub(crate) fn axes(
    out: &mut Drawing,
    area: Area,
    (x, x_scale): (&Fitted, &Scale),
    (y, y_scale): (&Fitted, &Scale),
) -> Area {
    let widest = y
        .ticks()
        .map(|(_, t)| text_width(t, SMALL))
        .fold(0.0, f64::max);
    let plot = area.inside(widest + 34.0, 0.0, 22.0, 46.0);
    x_ticks(out, plot, x, x_scale.label(), true);
    y_ticks(out, plot, y, y_scale.label());
    out.outline(plot, 1.0, FRAME);
    plot
}

/// Draws ticks, their labels and the axis label below the plot; grid lines when wanted.
pub(crate) fn x_ticks(out: &mut Drawing, plot: Area, x: &Fitted, label: &str, grid: bool) {
    for (place, text) in x.ticks() {
        let at = plot.x + place * plot.width;
        if grid {
            out.path(vec![(at, plot.y), (at, plot.bottom())], 1.0, GRID);
        }
        out.path(
            vec![(at, plot.bottom()), (at, plot.bottom() + 4.0)],
            1.0,
            FRAME,
        );
        out.text((at, plot.bottom() + 13.0), text, SMALL, Anchor::Middle);
    }
    let middle = plot.x + plot.width / 2.0;
    out.text((middle, plot.bottom() + 33.0), label, LABEL, Anchor::Middle);
}

/// Draws grid lines, ticks, their labels and the axis label left of the plot.
pub(crate) fn y_ticks(out: &mut Drawing, plot: Area, y: &Fitted, label: &str) {
    let mut widest = 0.0_f64;
    for (place, text) in y.ticks() {
        let at = plot.bottom() - place * plot.height;
        out.path(vec![(plot.x, at), (plot.right(), at)], 1.0, GRID);
        out.path(vec![(plot.x - 4.0, at), (plot.x, at)], 1.0, FRAME);
        out.text((plot.x - 7.0, at), text, SMALL, Anchor::End);
        widest = widest.max(text_width(text, SMALL));
    }
    out.label(Text {
        at: (plot.x - widest - 21.0, plot.y + plot.height / 2.0),
        text: label.to_string(),
        size: LABEL,
        anchor: Anchor::Middle,
        colour: INK,
        bold: false,
        vertical: true,
    });
}

/// The mark of an entry in a legend.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Key {
    /// A piece of line.
    Line,
    /// A piece of dashed line.
    Dashes,
    /// A dot.
    Dot,
    /// A small square.
    Square,
}

/// An entry of a legend.
pub(crate) type Entry<'a> = (Key, Colour, &'a str);

/// Draws a legend in a corner of the plot, on a ground that lets what lies below shine through.
pub(crate) fn legend(out: &mut Drawing, plot: Area, corner: Corner, entries: &[Entry]) {
    let entries: Vec<_> = entries.iter().filter(|e| !e.2.is_empty()).collect();
    const LINE: f64 = 17.0;
    let text = entries
        .iter()
        .map(|e| text_width(e.2, SMALL))
        .fold(0.0, f64::max);
    let (width, height) = (text + 44.0, LINE * entries.len() as f64 + 8.0);
    let (left, top) = (plot.x + 8.0, plot.y + 8.0);
    let (right, bottom) = (plot.right() - width - 8.0, plot.bottom() - height - 8.0);
    let (x, y) = match corner {
        Corner::TopLeft => (left, top),
        Corner::BottomLeft => (left, bottom),
        Corner::BottomRight => (right, bottom),
        Corner::TopRight => (right, top),
        Corner::Above | Corner::None => return,
    };
    if entries.is_empty() {
        return;
    }
    let area = Area {
        x,
        y,
        width,
        height,
    };
    out.rect(area, PAPER.with_opacity(0.85));
    out.outline(area, 1.0, GRID);
    for (i, entry) in entries.iter().enumerate() {
        legend_entry(out, (x + 8.0, y + 4.0 + LINE * (i as f64 + 0.5)), entry);
    }
}

/// Draws a legend in rows above the plot, when it belongs there; gives back the area below it.
pub(crate) fn legend_above(
    out: &mut Drawing,
    area: Area,
    corner: Corner,
    entries: &[Entry],
) -> Area {
    let entries = entries.iter().filter(|e| !e.2.is_empty());
    if corner != Corner::Above {
        return area;
    }
    let (left, mut x, mut y) = (area.x + 44.0, area.x + 44.0, area.y + 7.0);
    let mut used = 0.0;
    for entry in entries {
        let width = text_width(entry.2, SMALL) + 46.0;
        if x > left && x + width > area.right() {
            (x, y) = (left, y + 17.0);
        }
        legend_entry(out, (x, y), entry);
        x += width;
        used = y + 15.0 - area.y;
    }
    area.inside(0.0, used, 0.0, 0.0)
}

fn legend_entry(out: &mut Drawing, (x, y): (f64, f64), (key, colour, name): &Entry) {
    let line = [(x, y), (x + 22.0, y)];
    match key {
        Key::Line => out.path(line.to_vec(), 2.0, *colour),
        Key::Dashes => out.dashes(&line, 2.0, *colour),
        Key::Dot => out.disc((x + 11.0, y), 3.5, *colour),
        Key::Square => out.rect(
            Area {
                x: x + 8.0,
                y: y - 5.5,
                width: 11.0,
                height: 11.0,
            },
            *colour,
        ),
    }
    out.text((x + 28.0, y), name, SMALL, Anchor::Start);
}

/// A text in muted colour.
pub(crate) fn muted(out: &mut Drawing, at: (f64, f64), text: &str, size: f64, anchor: Anchor) {
    out.label(Text {
        at,
        text: text.to_string(),
        size,
        anchor,
        colour: MUTED,
        bold: false,
        vertical: false,
    });
}

#[cfg(test)]
mod tests {
    use super::super::drawing::Mark;
    use super::*;

    #[test]
    fn a_legend_holds_its_entries_and_lies_in_its_corner() {
        let plot = Area {
            x: 50.0,
            y: 30.0,
            width: 400.0,
            height: 300.0,
        };
        let names = ["one", "a long name", "", "three", "four"];
        let entries = names.map(|name| (Key::Square, INK, name));
        for corner in [
            Corner::TopLeft,
            Corner::TopRight,
            Corner::BottomLeft,
            Corner::BottomRight,
        ] {
            let mut out = Drawing::new(500.0, 400.0);
            legend(&mut out, plot, corner, &entries);
            let ground = out.marks.iter().find_map(|mark| match mark {
                Mark::Fill { points, .. } => Some(points.clone()),
                _ => None,
            });
            let ground = ground.unwrap();
            let ends = |f: fn(&(f64, f64)) -> f64| {
                let all = ground.iter().map(f);
                (
                    all.clone().fold(f64::INFINITY, f64::min),
                    all.fold(f64::NEG_INFINITY, f64::max),
                )
            };
            let (xs, ys) = (ends(|p| p.0), ends(|p| p.1));
            assert!(
                xs.0 >= plot.x && xs.1 <= plot.right() && ys.0 >= plot.y && ys.1 <= plot.bottom()
            );
            let right = matches!(corner, Corner::TopRight | Corner::BottomRight);
            let bottom = matches!(corner, Corner::BottomLeft | Corner::BottomRight);
            assert_eq!(xs.1 > plot.x + 0.6 * plot.width, right);
            assert_eq!(ys.1 > plot.y + 0.6 * plot.height, bottom);
            let texts = out.marks.iter().filter_map(|mark| match mark {
                Mark::Text(text) => Some(text),
                _ => None,
            });
            let texts: Vec<_> = texts.collect();
            assert_eq!(texts.len(), 4);
            for text in texts {
                let half = 0.5 * text.size;
                assert!(
                    text.at.1 - half >= ys.0 && text.at.1 + half <= ys.1,
                    "{text:?} {ys:?}"
                );
                assert!(text.at.0 >= xs.0 && text.at.0 + text_width(&text.text, text.size) <= xs.1);
            }
        }
    }
}
