//! `edifice facade compare`.

use std::path::{Path, PathBuf};

use edifice_base::{Error, Result};
use edifice_shape::comparison::{Agreement, Comparison, Regularity, THRESHOLDS, compare_layouts};
use serde_json::{Value, json};

use super::input;
use crate::print;
use crate::reading::Reading;

/// Options of `facade compare`.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  edifice facade compare datasets/facade_grammar/layouts/office_1.facade.json whole.facade.json --json
  edifice facade compare datasets/facade_grammar/layouts/office_1.facade.json answers/*.facade.json

Elements of one label are paired one to one by falling intersection over union (IoU). F1 is told at IoU 0.5, 0.75 and as the mean
over 0.5, 0.55, ..., 0.95. Of predictions with the key \"unknown\" only elements are compared whose centre lies in it.")]
pub(crate) struct Args {
    /// True layout: .facade.json, COCO, LabelMe, or any other format that `facade convert` reads
    #[arg(value_name = "TRUTH")]
    truth: PathBuf,
    /// Predicted layouts of the same facade
    #[arg(value_name = "PRED", required = true)]
    predicted: Vec<PathBuf>,
    /// Compare the whole layouts, though a prediction says which part was unknown
    #[arg(long)]
    whole: bool,
    #[command(flatten)]
    reading: Reading,
    /// End standard output with one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let truth = input::annotated(&args.truth, &args.reading)?;
    let mut told = Vec::new();
    print::line("f1@.5   f1@.75  mean f1  iou     true  pred  overlap  prediction")?;
    for path in &args.predicted {
        let predicted = input::annotated(path, &args.reading)?;
        let found =
            compare_layouts(&truth, &predicted, args.whole).map_err(|e| Error::content(path, e))?;
        let (f1, all) = (found.all.f1(), &found.all);
        print::line(&format!(
            "{:<8.4}{:<8.4}{:<9.4}{:<8.4}{:<6}{:<6}{:<9.4}{}",
            f1[0],
            f1[5],
            all.mean_f1(),
            all.iou,
            all.truth,
            all.predicted,
            found.predicted.overlap,
            path.display()
        ))?;
        for (label, own) in &found.labels {
            print::line(&format!(
                "{:<8.4}{:<8.4}{:<9.4}{:<8.4}{:<6}{:<6}         {label}",
                own.f1()[0],
                own.f1()[5],
                own.mean_f1(),
                own.iou,
                own.truth,
                own.predicted
            ))?;
        }
        told.push(object(&found, path));
    }
    match args.json {
        true => print::line(
            &json!({ "truth": args.truth.display().to_string(), "predictions": told }).to_string(),
        ),
        false => Ok(()),
    }
}

fn object(found: &Comparison, path: &Path) -> Value {
    let labels: serde_json::Map<String, Value> = (found.labels.iter())
        .map(|(label, own)| (label.clone(), agreement(own)))
        .collect();
    let calibration = found.calibration.map(
        |c| json!({ "elements": c.elements, "brier": c.brier, "expected_calibration_error": c.error }),
    );
    let mut told = agreement(&found.all);
    told["file"] = path.display().to_string().into();
    told["labels"] = labels.into();
    told["regularity"] = json!({
        "truth": regularity(&found.truth), "predicted": regularity(&found.predicted),
    });
    told["calibration"] = calibration.unwrap_or(Value::Null);
    told
}

fn agreement(own: &Agreement) -> Value {
    let f1: serde_json::Map<String, Value> = (THRESHOLDS.iter().zip(own.f1()))
        .map(|(at, value)| (format!("{at}"), value.into()))
        .collect();
    json!({
        "f1": f1, "mean_f1": own.mean_f1(), "iou": own.iou, "truth": own.truth, "predicted": own.predicted,
        "count_error": own.predicted.abs_diff(own.truth),
    })
}

fn regularity(own: &Regularity) -> Value {
    json!({ "overlap": own.overlap, "distinct_edges": own.distinct_edges })
}
