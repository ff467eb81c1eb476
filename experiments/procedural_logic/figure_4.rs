//! Fig. 4: cumulative match characteristics, and every miss with its reason.

use super::data::{Source, sources};
use super::gold::{Architecture, Doors};
use super::{RANKS, row, trivial};
use edifice_base::{Error, Result};
use edifice_cluster::{
    MatchCurve, Protocol, Query, Ties, Unmatched, cumulative_match, match_curve,
};
use edifice_frame::Context;
use edifice_procedural_logic::{Measure, Model, Parameters};
use edifice_report::{Align, Chart, Corner, Figure, Scale, Series, Table};
use nalgebra::DMatrix;

/// A distance by name, its curve under the protocol of the figure, and its matrix.
type Curve<'a> = (&'a str, MatchCurve, &'a DMatrix<f64>);

/// A query whose expectation at rank 2 is below this counts as missed.
const MISSED: f64 = 0.5;

/// Ranks the facades of each set by each measure.
pub(crate) fn run(ctx: &mut Context) -> Result<()> {
    for source in sources(ctx)? {
        let model = Model::fit(&source.grids, Parameters::RETRIEVAL).map_err(Error::method)?;
        let profiles = model.profiles().map_err(Error::method)?;
        let mut table = Table::new(format!("Retrieval on {}", source.dataset))
            .column("measure", Align::Left)
            .column("doors compared by", Align::Left)
            .numbers(["queries", "rank 1", "rank 2", "rank 5", "rank 20"]);
        let mut curves = Vec::new();
        let measures = Measure::ALL.map(|measure| (measure.name(), measure.matrix(&profiles)));
        let counts = (trivial::NAME, trivial::distances(&source.grids));
        let all: Vec<(&str, DMatrix<f64>)> = measures.into_iter().chain([counts]).collect();
        for (name, distances) in &all {
            for doors in Doors::ALL {
                let curve = retrieve(distances, &source.architecture, doors);
                observe(ctx, &source, name, doors, &curve);
                table.row(line(name, doors, &curve));
                if doors == Doors::Layout {
                    curves.push((*name, curve, distances));
                }
            }
        }
        // No distance that is blind to sizes can do better than to tell structures apart.
        let start = |i: usize| model.facades[i].instance.start;
        let n = source.grids.len();
        let perfect = DMatrix::from_fn(n, n, |i, j| {
            let changes = source.architecture[i].changes(&source.architecture[j], Doors::Layout);
            changes as f64 + if start(i) == start(j) { 0.0 } else { 0.25 }
        });
        for doors in Doors::ALL {
            let curve = retrieve(&perfect, &source.architecture, doors);
            observe(ctx, &source, "size_blind_ceiling", doors, &curve);
            table.row(line("size-blind ceiling", doors, &curve));
        }
        ctx.table(&table);
        protocols(ctx, &source, &all);
        if source.is_paper() {
            compare(ctx, &curves);
        }
        if source.pictured {
            draw(ctx, &source, &curves)?;
        }
        for (name, curve, distances) in &curves {
            if *name == Measure::Powerset.name() {
                explain(ctx, &source, &model, curve, distances);
            }
        }
    }
    ctx.note(NOTE);
    Ok(())
}

const NOTE: &str = "Each facade queries all others (it is not ranked itself); found is any facade without \
    architectural change; facades at equal distance come in random order and the rates are exact expectations \
    over it; facades that no other equals are no queries. *common_rules* follows the words of Sec. 4.3 (rules shared \
    by two facades); *all_rules* takes the rules of both, *rule_union* the ratio of Eq. 14; *lattice* is not of the paper: \
    it reads rows and columns of windows off the labels, without rules, and counts the changes of the gold standard. Doors compared by *layout* \
    (at an end of the ground floor or between other elements) is the gold standard of the figure; *third* and *column* \
    also ask where along the facade the door stands, which is a size, and Sec. 5.4 excludes sizes: the rows *size-blind \
    ceiling* show what any distance on structures alone can reach then (it ranks by the true number of changes, and \
    facades of the same starting rule first). *shipped_houses* holds every structure at five sizes: to find those \
    at once shows that a distance is blind to sizes, not more. \
    *component_counts* is a trivial baseline: the L1 distance between the numbers of connected areas of each label, \
    without a single split or rule. On exact labels it is as good as powersets, so these curves say nothing for split \
    trees: a gold standard that counts floors, columns, doors and balconies is met by counting. Mind also that \
    of the gold standard only floors and columns are annotated by hand; doors and running balconies are read \
    off the very labels that are compared. The other readings of the protocol: *ties against us* puts \
    identical facades last among equal distances; *every facade queries* counts the facades that no other \
    equals as never found; *the query is ranked too* finds itself at distance 0 and is 100 % but for ties; *all by hand* \
    takes running balconies from the annotation (`floor_balcony_annotation.txt`) and no doors.";

/// The curve of a distance matrix under one reading of the gold standard.
pub(crate) fn retrieve(
    distances: &DMatrix<f64>,
    architecture: &[Architecture],
    doors: Doors,
) -> MatchCurve {
    let identical = |a: usize, b: usize| architecture[a].changes(&architecture[b], doors) == 0;
    cumulative_match(distances, identical, RANKS, Query::LeftOut)
}

/// The other readings of the protocol, for every distance: who is a query, how ties count, and what of
/// the gold standard is annotated by hand.
fn protocols(ctx: &mut Context, source: &Source, all: &[(&str, DMatrix<f64>)]) {
    let figure = Protocol {
        query: Query::LeftOut,
        ties: Ties::Random,
        unmatched: Unmatched::LeftOut,
    };
    let against = Protocol {
        ties: Ties::Against,
        ..figure
    };
    let missed = Protocol {
        unmatched: Unmatched::Missed,
        ..figure
    };
    let included = Protocol {
        query: Query::Included,
        ..figure
    };
    let own = &source.architecture;
    let coarse: Vec<Architecture> = own.iter().map(Architecture::floors_and_columns).collect();
    let mut readings = vec![
        ("as in the figure", "", figure, own),
        ("ties against us", "ties_against", against, own),
        ("every facade queries", "all_queries", missed, own),
        (
            "every facade queries, ties against us",
            "all_queries_ties_against",
            Protocol {
                ties: Ties::Against,
                ..missed
            },
            own,
        ),
        ("the query is ranked too", "query_included", included, own),
        (
            "gold: floors and columns only",
            "gold_floors_columns",
            figure,
            &coarse,
        ),
    ];
    if !source.by_hand.is_empty() {
        readings.push((
            "gold: all by hand, no doors",
            "gold_by_hand",
            figure,
            &source.by_hand,
        ));
    }
    let mut table = Table::new(format!(
        "Other readings of the protocol on {}",
        source.dataset
    ))
    .column("measure", Align::Left)
    .column("protocol", Align::Left)
    .numbers(["queries", "rank 1", "rank 2", "rank 5", "rank 20"]);
    for (name, distances) in all {
        for (words, suffix, protocol, gold) in &readings {
            let identical = |a: usize, b: usize| gold[a].changes(&gold[b], Doors::Layout) == 0;
            let curve = match_curve(distances, identical, RANKS, *protocol);
            table.row(cells(name, words, &curve));
            if !suffix.is_empty() {
                rates(ctx, source, &format!("{name}/{suffix}"), &curve);
            }
        }
    }
    ctx.table(&table);
}

fn observe(ctx: &mut Context, source: &Source, measure: &str, doors: Doors, curve: &MatchCurve) {
    let method = match doors {
        Doors::Layout => measure.to_owned(),
        other => format!("{measure}/doors_by_{}", other.name()),
    };
    rates(ctx, source, &method, curve);
}

/// The rates of a curve, and its number of queries.
fn rates(ctx: &mut Context, source: &Source, method: &str, curve: &MatchCurve) {
    for (index, &rate) in curve.rates.iter().enumerate() {
        let instance = format!("rank_{}", index + 1);
        ctx.observe(row(source.dataset, method, instance, "cmc", rate));
    }
    let queries = curve.queries.len() as f64;
    ctx.observe(row(source.dataset, method, "all", "queries", queries));
}

fn line(measure: &str, doors: Doors, curve: &MatchCurve) -> Vec<String> {
    cells(measure, doors.name(), curve)
}

fn cells(measure: &str, reading: &str, curve: &MatchCurve) -> Vec<String> {
    let rate = |rank: usize| {
        let rate = curve.rates.get(rank - 1);
        rate.map_or_else(String::new, |rate| format!("{:.1} %", 100.0 * rate))
    };
    let queries = curve.queries.len().to_string();
    vec![
        measure.into(),
        reading.into(),
        queries,
        rate(1),
        rate(2),
        rate(5),
        rate(20),
    ]
}

fn compare(ctx: &mut Context, curves: &[Curve]) {
    let percent = |name: &str, rank: usize| {
        let curve = curves.iter().find(|c| c.0 == name);
        let rate = curve.and_then(|c| c.1.rates.get(rank - 1)).copied();
        rate.map_or_else(|| "-".into(), |rate| format!("{:.1} %", 100.0 * rate))
    };
    for (quantity, printed, measure, rank) in [
        ("powersets, rank 1", "87 %", Measure::Powerset, 1),
        ("powersets, rank 2", "100 %", Measure::Powerset, 2),
        ("common rules, rank 2", "56 %", Measure::CommonRules, 2),
        ("all rules, rank 2", "", Measure::AllRules, 2),
    ] {
        ctx.compare(quantity, printed, percent(measure.name(), rank));
    }
    for rank in [1, 2] {
        let quantity = format!("rows and columns read off the labels, rank {rank}");
        ctx.compare(quantity, "", percent(Measure::Lattice.name(), rank));
    }
    for rank in [1, 2] {
        let quantity = format!("trivial baseline (component counts), rank {rank}");
        ctx.compare(quantity, "", percent(trivial::NAME, rank));
    }
}

fn draw(ctx: &mut Context, source: &Source, curves: &[Curve]) -> Result<()> {
    let rank = Scale::new("rank k").range(1.0, RANKS as f64);
    let mut chart = Chart::new(
        format!("{}: identical facade within the first k", source.dataset),
        rank,
        Scale::new("rate").range(0.0, 1.02),
    )
    .legend(Corner::BottomRight);
    for (name, curve, _) in curves {
        let points = curve.rates.iter().enumerate();
        let points = points
            .map(|(index, &rate)| ((index + 1) as f64, rate))
            .collect();
        chart = chart.series(Series::marked(*name, points));
    }
    let figure = Figure::single(
        "Cumulative match characteristics of facade retrieval",
        chart,
    );
    ctx.figure(&source.figure("figure_4"), &figure)
}

/// Every query that is not found at rank 1 for sure, and what stands in its way.
fn explain(
    ctx: &mut Context,
    source: &Source,
    model: &Model,
    curve: &MatchCurve,
    distances: &DMatrix<f64>,
) {
    let mut table = Table::new(format!(
        "{}: queries short of certainty at rank 1, powersets",
        source.dataset
    ))
    .column("facade", Align::Left)
    .numbers(["rank 1", "rank 2"])
    .column("what the gold standard says", Align::Left)
    .column("what stands in the way", Align::Left);
    for (query, rates) in &curve.queries {
        if rates[0] > 1.0 - 1e-9 {
            continue;
        }
        let own = &source.architecture[*query];
        let nearest = (0..source.grids.len())
            .filter(|&i| i != *query && own.changes(&source.architecture[i], Doors::Layout) > 0)
            .min_by(|&a, &b| distances[(*query, a)].total_cmp(&distances[(*query, b)]));
        let reason = nearest.map_or_else(String::new, |i| {
            let same = model.facades[i].instance.start == model.facades[*query].instance.start;
            let what = difference(own, &source.architecture[i]);
            let labels = if same {
                "the same structure in the labels"
            } else {
                "a near structure"
            };
            format!("{} has {labels} but {what}", source.grids[i].name)
        });
        table.row([
            source.grids[*query].name.clone(),
            format!("{:.2}", rates[0]),
            format!("{:.2}", rates[1]),
            describe(own),
            reason,
        ]);
        let missed = f64::from(u8::from(rates[1] < MISSED));
        ctx.observe(row(
            source.dataset,
            "powerset",
            &source.grids[*query].name,
            "missed_at_rank_2",
            missed,
        ));
    }
    if !table.is_empty() {
        ctx.table(&table);
    }
}

fn describe(a: &Architecture) -> String {
    let doors = if a.doors[0].is_empty() {
        "no door"
    } else {
        "door"
    };
    format!(
        "{} floors, {} columns, {doors}, balconies {:?}",
        a.floors, a.columns, a.balconies
    )
}

/// The differences of two architectures, in words.
fn difference(own: &Architecture, other: &Architecture) -> String {
    let mut parts = Vec::new();
    if own.floors != other.floors {
        parts.push(format!(
            "{} floors annotated against {}",
            other.floors, own.floors
        ));
    }
    if own.columns != other.columns {
        parts.push(format!(
            "{} columns annotated against {}",
            other.columns, own.columns
        ));
    }
    if own.doors[0] != other.doors[0] {
        parts.push("the door elsewhere".into());
    }
    if own.balconies != other.balconies {
        parts.push(format!(
            "balconies {:?} against {:?}",
            other.balconies, own.balconies
        ));
    }
    parts.join(", ")
}
