//! Why ours is not the lowest of Fig. 12 on a set: on which attribute the likelihood is lost, and
//! whether the loss goes when both models are learned without that attribute.

use edifice_base::{Error, Result};
use edifice_frame::Context;
use edifice_frame::averages::mean_and_error;
use edifice_model::hierarchy::Settings;
use edifice_model::tables::Dataset;
use edifice_model::tables::compare::{Contender, Judged, held_out, judge, split};
use edifice_report::{Align, Table};

/// Mean losses of all contenders on one set, in their order.
pub(crate) struct Means {
    pub of: [f64; 5],
}

impl Means {
    /// The best of the models that ours is not clearly below.
    pub(crate) fn rival(&self, level: &[Contender]) -> Option<Contender> {
        let mean = |c: &Contender| {
            let at = Contender::ALL.iter().position(|k| k == c);
            at.map_or(f64::INFINITY, |at| self.of[at])
        };
        let best = level.iter().min_by(|a, b| mean(a).total_cmp(&mean(b)));
        best.copied()
    }
}

/// Compares ours with `rival` attribute by attribute on the splits of the figure, then learns both
/// without the attribute on which ours loses most.
pub(crate) fn explain(
    ctx: &mut Context,
    name: &str,
    data: &Dataset,
    rival: Contender,
    settings: &Settings,
    splits: u64,
) -> Result<()> {
    let seed = ctx.seed();
    let mut units = Vec::new();
    for index in 0..splits {
        units.extend([(index, Contender::Ours), (index, rival)]);
    }
    let parts = |data: &Dataset, index: u64| {
        let (train, test) = split(data.table.rows(), 0.8, seed, index);
        (data.select(&train), data.select(&test))
    };
    let judged: Vec<Option<Judged>> = ctx.units(
        &units,
        |(index, c)| format!("reason/{name}/{index}/{}", c.name()),
        |&(index, contender)| {
            let (train, test) = parts(data, index);
            judge(contender, &train, &test, settings, seed).map_err(Error::method)
        },
    )?;
    let of = |contender: Contender| -> Vec<&Judged> {
        let own = units
            .iter()
            .zip(&judged)
            .filter(|((_, c), _)| *c == contender);
        own.filter_map(|(_, j)| j.as_ref()).collect()
    };
    let (ours, theirs) = (of(Contender::Ours), of(rival));
    if ours.is_empty() || ours.len() != theirs.len() {
        return Ok(());
    }
    let paired = |f: &dyn Fn(&Judged) -> f64| {
        let differences: Vec<f64> = ours.iter().zip(&theirs).map(|(a, b)| f(b) - f(a)).collect();
        mean_and_error(&differences)
    };
    let mut lost = Vec::new();
    for (g, (attribute, _)) in ours[0].attributes.iter().enumerate() {
        lost.push((attribute.clone(), paired(&|j| j.attributes[g].1)));
    }
    lost.sort_by(|a, b| a.1.0.total_cmp(&b.1.0));
    let title = format!(
        "{name}: nats of an attribute given all others, {} above ours",
        rival.name()
    );
    let mut table = Table::new(&title)
        .column("attribute", Align::Left)
        .numbers(["above ours", "its standard error"]);
    for (attribute, (gap, error)) in &lost {
        table.row([
            attribute.clone(),
            format!("{gap:.2}"),
            format!("{error:.2}"),
        ]);
    }
    ctx.table(&table);
    let (gap, error) = paired(&|j| j.loss);
    let edges = ours.iter().map(|j| j.edges as f64).sum::<f64>() / ours.len() as f64;
    let (attribute, (worst, _)) = lost[0].clone();
    let mut note = format!(
        "`{name}`, why: {} is {gap:.2} \u{b1} {error:.2} nats above ours, which has {edges:.1} lateral edges on average. ",
        rival.name()
    );
    if rival == Contender::Model1 && gap.abs() <= 2.0 * error {
        note += "Lateral edges are all that model_1 lacks: the few that the score takes say little here that the hidden \
                 variables do not say. ";
    }
    if worst >= 0.0 {
        note += "On no attribute does ours lose: the two say the same.";
    } else {
        let less = data.without(&attribute).map_err(Error::method)?;
        let losses: Vec<f64> = ctx.units(
            &units,
            |(index, c)| format!("reason/{name}/without/{attribute}/{index}/{}", c.name()),
            |&(index, contender)| {
                let (train, test) = parts(&less, index);
                let losses = held_out(contender, &train, &test, settings, seed);
                Ok(mean_and_error(&losses.map_err(Error::method)?).0)
            },
        )?;
        let differences: Vec<f64> = losses.chunks(2).map(|pair| pair[1] - pair[0]).collect();
        let (gap_less, error_less) = mean_and_error(&differences);
        let ends = if gap_less > 2.0 * error_less {
            "ours is lower: that attribute is the reason"
        } else if gap_less > gap {
            "ours gains on it: that attribute is part of the reason"
        } else {
            "the difference stays: the reason is not that attribute alone"
        };
        note += &format!(
            "Ours loses most on `{attribute}` ({:.2} nats given all others). With both learned anew without it, {} is \
             {gap_less:.2} \u{b1} {error_less:.2} nats above ours: {ends}.",
            -worst,
            rival.name()
        );
    }
    ctx.note(note);
    Ok(())
}
