//! Draws as tables: CSV, and JSON as ArviZ reads it.

use std::collections::BTreeMap;

use edifice_base::csv;
use serde_json::{Value as Json, json};

use super::posterior::{Posterior, name};

/// Indices of a number of one name, and its values by draw.
type Numbered = (Vec<usize>, Vec<f64>);

impl<T> Posterior<T> {
    /// The draws as CSV, one a line: `chain,draw,weight,log_prior,log_likelihood` and a column for each number that was chosen,
    /// empty where a draw has none. Numbers are written so that they are read back the same.
    ///
    /// # Examples
    /// ```
    /// use edifice_model::program::{Handler, Program, dist::bernoulli, exact};
    /// struct Coin;
    /// impl Program for Coin {
    ///     type Out = ();
    ///     fn run<H: Handler>(&self, h: &mut H) { h.sample("heads", bernoulli(0.5)); }
    /// }
    /// let text = exact(&Coin)?.to_csv();
    /// assert!(text.starts_with("chain,draw,weight,log_prior,log_likelihood,heads\n0,0,0.5,"));
    /// # Ok::<(), edifice_model::program::ProgramError>(())
    /// ```
    pub fn to_csv(&self) -> String {
        let columns = self.columns();
        let mut text = "chain,draw,weight,log_prior,log_likelihood".to_owned();
        for (at, coordinate, _) in &columns {
            text += ",";
            text += &csv::cell(&name(at, *coordinate));
        }
        text += "\n";
        let length = (self.draws.len() / self.chains().max(1)).max(1);
        for (i, draw) in self.draws.iter().enumerate() {
            let weight = draw.log_weight.exp();
            let (prior, likelihood) = (draw.trace.log_prior(), draw.trace.log_likelihood());
            text += &format!(
                "{},{},{weight},{prior},{likelihood}",
                i / length,
                i % length
            );
            for (_, _, values) in &columns {
                text += ",";
                if !values[i].is_nan() {
                    text += &values[i].to_string();
                }
            }
            text += "\n";
        }
        text
    }

    /// The draws as the JSON of ArviZ's `InferenceData` (`arviz.from_json`): the group `posterior` has an array
    /// `[chain][draw]` for each name, with the indices of its addresses as further dimensions, `sample_stats` has `lp`, the logarithm of the
    /// unnormalised density, `diverging` where it is known, and `log_weight` of weighted draws.
    ///
    /// Numbers that a draw has not are null.
    pub fn to_inference_data(&self) -> String {
        let mut names: BTreeMap<String, Vec<Numbered>> = BTreeMap::new();
        for (at, coordinate, values) in self.columns() {
            let mut index: Vec<usize> = at.indices().iter().map(|&i| i as usize).collect();
            index.extend(coordinate);
            let list = names.entry(at.name().to_owned()).or_default();
            list.push((index, values));
        }
        let length = (self.draws.len() / self.chains().max(1)).max(1);
        let chains = |one: &dyn Fn(usize) -> Json| -> Json {
            let all: Vec<Json> = (0..self.draws.len()).map(one).collect();
            all.chunks(length).map(|c| Json::from(c.to_vec())).collect()
        };
        let mut posterior = serde_json::Map::new();
        for (name, entries) in names {
            let depth = entries
                .iter()
                .map(|(index, _)| index.len())
                .max()
                .unwrap_or(0);
            // The same name with different numbers of indices: each number under its own name.
            if entries.iter().any(|(index, _)| index.len() != depth) {
                for (index, values) in &entries {
                    let index: Vec<String> = index.iter().map(usize::to_string).collect();
                    let name = format!("{name}[{}]", index.join(","));
                    posterior.insert(name, chains(&|i| number(values[i])));
                }
                continue;
            }
            let shape = (0..depth).map(|d| entries.iter().map(|(index, _)| index[d] + 1).max());
            let shape: Vec<usize> = shape.map(|n| n.unwrap_or(0)).collect();
            let places: BTreeMap<&[usize], &Vec<f64>> =
                entries.iter().map(|(index, v)| (&index[..], v)).collect();
            let array = |i: usize| nested(&shape, &mut Vec::new(), &places, i);
            posterior.insert(name, chains(&array));
        }
        let mut stats = serde_json::Map::new();
        stats.insert(
            "lp".to_owned(),
            chains(&|i| number(self.draws[i].trace.log_joint())),
        );
        let weights = chains(&|i| number(self.draws[i].log_weight));
        stats.insert("log_weight".to_owned(), weights);
        if self.diverging.len() == self.draws.len() {
            let diverging = chains(&|i| Json::from(self.diverging[i]));
            stats.insert("diverging".to_owned(), diverging);
        }
        let all = json!({
            "posterior": posterior,
            "sample_stats": stats,
            "posterior_attrs": {"inference_library": "edifice"},
        });
        all.to_string()
    }
}

/// A number, or null where it is none.
fn number(value: f64) -> Json {
    Json::from(value)
}

/// The numbers of draw i as nested arrays.
fn nested(
    shape: &[usize],
    index: &mut Vec<usize>,
    places: &BTreeMap<&[usize], &Vec<f64>>,
    i: usize,
) -> Json {
    let Some(&n) = shape.get(index.len()) else {
        let found = places.get(&index[..]).map_or(f64::NAN, |v| v[i]);
        return number(found);
    };
    let each = (0..n).map(|k| {
        index.push(k);
        let inner = nested(shape, index, places, i);
        index.pop();
        inner
    });
    each.collect()
}
