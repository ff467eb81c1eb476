//! `edifice building import`.

use std::path::PathBuf;

use edifice_base::{Error, Result, csv};
use edifice_building_exteriors::survey::{Candidate, Limits, Refused, Surveyed, survey_all};
use edifice_io::{building_json, write_atomic};
use edifice_io_city as city;
use edifice_shape::Building;
use edifice_shape::triangles::City;

use crate::print;

/// Options.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// City models, in every format that `edifice city` reads; several are tiles of one city.
    #[arg(required = true)]
    cities: Vec<PathBuf>,
    /// The file of houses to write (`*.buildings.jsonl`).
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// The report to write (CSV): a line for each building with its outcome, and how near the house is to it.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Smallest and largest plan in square metres.
    #[arg(long, value_delimiter = ',', num_args = 2, default_values_t = Limits::default().area)]
    area: Vec<f64>,
    /// Lowest and highest ridge over the ground in metres.
    #[arg(long, value_delimiter = ',', num_args = 2, default_values_t = Limits::default().height)]
    height: Vec<f64>,
    /// Least intersection over union of the measured and the fitted plan.
    #[arg(long, default_value_t = Limits::default().iou)]
    iou: f64,
    /// Take flat halls and sheds for houses too, where the file does not say what they are.
    #[arg(long)]
    all: bool,
    /// Print a line of JSON.
    #[arg(long)]
    json: bool,
}

impl Args {
    fn limits(&self) -> Result<Limits> {
        let pair = |option: &str, values: &[f64]| match values {
            [low, high] if *low > 0.0 && low < high && high.is_finite() => Ok([*low, *high]),
            _ => Err(Error::option(option, "expected LOW,HIGH above zero")),
        };
        if !(0.0..=1.0).contains(&self.iou) {
            return Err(Error::option("--iou", "must lie between 0 and 1"));
        }
        Ok(Limits {
            area: pair("--area", &self.area)?,
            height: pair("--height", &self.height)?,
            iou: self.iou,
            by_shape: !self.all,
            ..Limits::default()
        })
    }
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let limits = args.limits()?;
    let mut all = City::default();
    for (k, path) in args.cities.iter().enumerate() {
        let own = city::read(path)?;
        match k {
            0 => all = own,
            _ => all.merge(own),
        }
    }
    all.number_duplicates();
    let candidates = all.buildings.iter().map(|b| Candidate {
        name: &b.id,
        mesh: &b.mesh,
        attributes: &b.attributes,
    });
    let candidates: Vec<Candidate> = candidates.collect();
    let found = survey_all(&candidates, &limits);
    let houses: Vec<Building> = found.iter().flatten().map(|s| s.building.clone()).collect();
    if let Some(path) = &args.report {
        let mut text =
            String::from("building,outcome,house,iou,volume,height_error,boxes,year,why\n");
        for (own, outcome) in candidates.iter().zip(&found) {
            text.push_str(&line(own.name, outcome));
        }
        write_atomic(path, text.as_bytes())?;
    }
    let counts = Counts::new(&found);
    if args.json {
        print::line(&counts.json().to_string())?;
    }
    for (reason, count) in &counts.refused {
        print::message(&format!("{count} refused: {reason}"));
    }
    if houses.is_empty() {
        let problem = format!("none of {} buildings is a detached house", found.len());
        return Err(Error::content(&args.cities[0], problem));
    }
    building_json::write_lines(&houses, &args.output)?;
    print::message(&format!(
        "{} houses of {} buildings in {}; {:.1} % of {} detached ones with plans of at least .95 intersection over union, of \
         these {:.1} % within 10 % of the volume",
        houses.len(),
        found.len(),
        args.output.display(),
        counts.percent(counts.near, counts.detached),
        counts.detached,
        counts.percent(counts.volume, counts.near),
    ));
    Ok(())
}

/// Numbers of buildings by outcome.
struct Counts {
    refused: std::collections::BTreeMap<&'static str, usize>,
    houses: usize,
    /// Of the right size, not attached, and no halls or sheds.
    detached: usize,
    /// With plans of at least .95 intersection over union, and of these within 10 % of the volume.
    near: usize,
    volume: usize,
}

impl Counts {
    fn new(found: &[std::result::Result<Surveyed, Refused>]) -> Self {
        let mut refused = std::collections::BTreeMap::new();
        for why in found.iter().filter_map(|f| f.as_ref().err()) {
            *refused.entry(why.reason()).or_default() += 1;
        }
        let apart = |why: &Refused| {
            matches!(
                why,
                Refused::NoSurface
                    | Refused::Size { .. }
                    | Refused::Attached
                    | Refused::NoDwelling { .. }
                    | Refused::Use(_)
            )
        };
        let outside = found
            .iter()
            .filter(|f| f.as_ref().err().is_some_and(apart))
            .count();
        let near: Vec<&Surveyed> = found
            .iter()
            .flatten()
            .filter(|s| s.fit.iou >= 0.95)
            .collect();
        Self {
            refused,
            houses: found.iter().flatten().count(),
            detached: found.len() - outside,
            near: near.len(),
            volume: near
                .iter()
                .filter(|s| (s.fit.volume - 1.0).abs() <= 0.1)
                .count(),
        }
    }

    fn percent(&self, part: usize, of: usize) -> f64 {
        100.0 * part as f64 / of.max(1) as f64
    }

    fn json(&self) -> serde_json::Value {
        serde_json::json!({
            "houses": self.houses, "detached": self.detached, "plan_iou_95": self.near,
            "volume_within_10_percent": self.volume, "refused": self.refused,
        })
    }
}

fn line(name: &str, outcome: &std::result::Result<Surveyed, Refused>) -> String {
    match outcome {
        Ok(s) => {
            let year = s.year.map_or(String::new(), |y| y.to_string());
            format!(
                "{},house,{},{:.4},{:.4},{:.3},{},{year},\n",
                csv::quoted(name),
                s.building.name,
                s.fit.iou,
                s.fit.volume,
                s.fit.height_error,
                s.fit.boxes
            )
        }
        Err(why) => format!(
            "{},{},,,,,,,{}\n",
            csv::quoted(name),
            why.reason(),
            csv::quoted(&why.to_string())
        ),
    }
}
