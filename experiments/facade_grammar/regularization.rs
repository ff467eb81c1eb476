//! Sec. 3.3: regularization of annotations by quadratic programming.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::{data, projection};
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_io::{LabelMap, label_image};
use edifice_layout::regularize::regularize_grid;
use edifice_report::{Align, Row, Table};

/// The effect of regularization on one facade.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Effect {
    lines: (usize, usize),
    windows: (usize, usize),
    largest_move: f64,
    seconds: f64,
}

/// The properties that regularization keeps, on every set; then distinct sizes of windows and cut lines before and
/// after, by tolerance, on the ECP labels.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    projection::table(ctx)?;
    let Some(folder) = ctx.real("facades/ecp2011/labels")? else {
        ctx.note("The second table needs the labels of ECP2011 (--data).");
        return Ok(());
    };
    let limit = ctx.budget().choose(2, usize::MAX, usize::MAX);
    let paths: Vec<PathBuf> = data::files(&folder, ".png")?
        .into_iter()
        .take(limit)
        .collect();
    let tolerances = [2.0, 4.0, 8.0];
    ctx.setting("tolerances", tolerances.to_vec());
    let mut units = Vec::new();
    for tolerance in tolerances {
        units.extend(paths.iter().map(|path| (tolerance, path)));
    }
    let found = ctx.units(
        &units,
        |(tolerance, path)| format!("{tolerance}/{}", data::stem(path, ".png")),
        |(tolerance, path)| {
            let grid = label_image::read(path, Some(&LabelMap::colors()))?;
            let start = std::time::Instant::now();
            let (_, report) = regularize_grid(&grid, *tolerance).map_err(Error::method)?;
            Ok(Effect {
                lines: report.lines,
                windows: report.sizes.get("window").copied().unwrap_or_default(),
                largest_move: report.largest_move,
                seconds: start.elapsed().as_secs_f64(),
            })
        },
    )?;
    let mut table = Table::new("Mean over the facades of ECP2011")
        .column("tolerance (px)", Align::Left)
        .numbers([
            "window sizes",
            "after",
            "cut lines",
            "after",
            "largest move (px)",
        ])
        .times(["ms"]);
    for tolerance in tolerances {
        let mine: Vec<&Effect> = units
            .iter()
            .zip(&found)
            .filter(|((t, _), _)| *t == tolerance)
            .map(|(_, effect)| effect)
            .collect();
        let mean = |of: &dyn Fn(&Effect) -> f64| {
            mine.iter().map(|e| of(e)).sum::<f64>() / mine.len() as f64
        };
        let largest = mine.iter().map(|e| e.largest_move).fold(0.0, f64::max);
        table.row([
            format!("{tolerance}"),
            format!("{:.1}", mean(&|e| e.windows.0 as f64)),
            format!("{:.1}", mean(&|e| e.windows.1 as f64)),
            format!("{:.1}", mean(&|e| e.lines.0 as f64)),
            format!("{:.1}", mean(&|e| e.lines.1 as f64)),
            format!("{largest:.0}"),
            format!("{:.1}", mean(&|e| 1e3 * e.seconds)),
        ]);
    }
    ctx.table(&table);
    for ((tolerance, path), effect) in units.iter().zip(&found) {
        let values = [
            ("window_sizes_before", effect.windows.0 as f64, ""),
            ("window_sizes", effect.windows.1 as f64, ""),
            ("lines_before", effect.lines.0 as f64, ""),
            ("lines", effect.lines.1 as f64, ""),
            ("largest_move", effect.largest_move, "px"),
            ("seconds", effect.seconds, "s"),
        ];
        for (metric, value, unit) in values {
            ctx.observe(Row {
                dataset: "ecp2011".into(),
                method: format!("tolerance_{tolerance}"),
                instance: data::stem(path, ".png"),
                metric: metric.into(),
                value,
                unit: unit.into(),
                ..Row::default()
            });
        }
    }
    ctx.note(
        "The paper regularizes \"if necessary\" by quadratic programming and prints no numbers.",
    );
    Ok(())
}
