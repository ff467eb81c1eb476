//! Section 5.5: "the most frequent rules correspond to" so many floors, columns, balconies, shops.

use std::collections::BTreeMap;

use super::data::sources;
use super::row;
use super::words::{Structure, rule_text};
use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_procedural_logic::{Model, Parameters, starting_rules};
use edifice_report::{Align, Table};

/// Starting rules and other rules listed.
const LISTED: usize = 12;

/// Lists the most frequent rules of each set, and the most frequent value of each feature.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    for source in sources(ctx)? {
        let model = Model::fit(&source.grids, Parameters::COMPRESSION).map_err(Error::method)?;
        let (rules, alphabet) = (&model.inference.rules, &model.alphabet);
        let starts = starting_rules(&model);
        let mut table = Table::new(format!("{}: starting rules", source.dataset))
            .numbers(["facades"])
            .column("in words", Align::Left);
        let mut features: BTreeMap<&str, BTreeMap<String, usize>> = BTreeMap::new();
        for (index, &(start, count)) in starts.iter().enumerate() {
            let Some(structure) = Structure::new(rules, alphabet, start) else {
                continue;
            };
            if index < LISTED {
                table.row([count.to_string(), structure.sentence()]);
                let instance = format!("start_{}", index + 1);
                ctx.observe(row(
                    source.dataset,
                    "inferred",
                    instance,
                    "facades",
                    count as f64,
                ));
            }
            let balconies = format!("{:?}", structure.balconies);
            let ground = if structure.shops { "shops" } else { "no shops" };
            for (feature, value) in [
                ("floors", structure.floors.to_string()),
                ("window columns", structure.columns.to_string()),
                ("running balconies", balconies),
                ("ground floor", ground.to_owned()),
            ] {
                *features
                    .entry(feature)
                    .or_default()
                    .entry(value)
                    .or_default() += count;
            }
        }
        ctx.table(&table);
        let mut table = Table::new(format!(
            "{}: most frequent value of each feature",
            source.dataset
        ))
        .column("feature", Align::Left)
        .column("value", Align::Left)
        .numbers(["facades"]);
        for (feature, values) in &features {
            if let Some((value, count)) = values.iter().max_by_key(|(_, count)| **count) {
                table.row([(*feature).to_owned(), value.clone(), count.to_string()]);
                ctx.observe(row(
                    source.dataset,
                    "inferred",
                    *feature,
                    "facades_with_most_frequent_value",
                    *count as f64,
                ));
            }
        }
        ctx.table(&table);
        let mut order: Vec<u32> = (0..rules.len() as u32).collect();
        order.sort_by_key(|&rule| (std::cmp::Reverse(rules.rules()[rule as usize].uses), rule));
        let mut table = Table::new(format!("{}: rules by use", source.dataset))
            .column("rule", Align::Left)
            .numbers(["uses"])
            .column("operation", Align::Left);
        for &rule in order.iter().take(LISTED) {
            let uses = rules.rules()[rule as usize].uses;
            table.row([
                format!("R{rule}"),
                uses.to_string(),
                rule_text(rules, alphabet, rule),
            ]);
        }
        ctx.table(&table);
        if source.is_paper() {
            let first = starts
                .iter()
                .find_map(|&(start, _)| Structure::new(rules, alphabet, start));
            ctx.compare(
                "the most frequent starting rule",
                "7 floors (including the ground and roof floor), 4 window columns, running balconies on the 2nd and 5th floors and shops on the ground floor",
                first.map_or_else(String::new, |structure| structure.sentence()),
            );
        }
    }
    Ok(())
}
