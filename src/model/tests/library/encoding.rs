//! Atoms, transforms and edges from categories: densities integrate to one, and nothing is lost on the way.

use edifice_base::rng::{Stream, stream};
use edifice_model::hierarchy::{Group, Settings, learn};
use edifice_model::network::Evidence;
use edifice_model::tables::Dataset;
use edifice_model::tables::compare::{Contender, held_out};
use edifice_model::tables::encoding::Encoding;
use edifice_model::tables::learn::extended;
use edifice_model::tables::transform::{Bounds, Tails, Transform};
use edifice_model::{Cell, Table};
use rand::RngExt;
use rand_distr::StandardNormal;

/// Any transform, degenerate parameters among them.
fn any_transform(rng: &mut Stream) -> Transform {
    let offset = 10f64.powf(rng.random_range(-6.0..6.0));
    let bounds = match rng.random_range(0..3) {
        0 => Bounds::None,
        1 => Bounds::Positive { offset },
        _ => Bounds::Share { offset },
    };
    let tails = rng.random::<bool>().then(|| Tails {
        centre: rng.random_range(-10.0..10.0),
        scale: 10f64.powf(rng.random_range(-3.0..3.0)),
    });
    Transform { bounds, tails }
}

#[test]
fn transforms_rise_and_their_slopes_and_inverses_are_their_own() {
    let mut rng = stream(1, "transforms", 0);
    for case in 0..20_000 {
        let transform = any_transform(&mut rng);
        let x = match case % 4 {
            0 => rng.random_range(0.0..1.0),
            1 => 10f64.powf(rng.random_range(-9.0..6.0)),
            2 => -10f64.powf(rng.random_range(-9.0..3.0)),
            _ => [0.0, 1.0, -0.0, 0.5][case / 4 % 4],
        };
        let (z, log_slope) = transform.forward(x);
        assert!(z.is_finite() && log_slope.is_finite(), "{transform:?} {x}");
        let step = 1e-6 * (1.0 + x.abs());
        let rise = transform.forward(x + step).0 - transform.forward(x - step).0;
        assert!(rise >= 0.0, "{transform:?} {x}");
        // A wide step in the curved part would not be the slope; there the smaller offsets are left to the inverse.
        let curved = match transform.bounds {
            Bounds::None => f64::INFINITY,
            Bounds::Positive { offset } => offset + x.abs(),
            Bounds::Share { offset } => offset + x.abs().min((1.0 - x).abs()),
        };
        let tails = transform.tails.map_or(f64::INFINITY, |t| t.scale);
        let smooth = step < 1e-4 * curved && step * log_slope.exp().max(1.0) < 1e-4 * tails;
        if smooth && rise > 1e-9 * (1.0 + z.abs()) {
            let near = (rise / (2.0 * step)).ln();
            assert!(
                (near - log_slope).abs() < 1e-2,
                "{transform:?} {x}: {near} {log_slope}"
            );
        }
        // One unit in the last place of z, as seen from x.
        let exact = 1e-12 * (1.0 + z.abs()) * (-log_slope).exp() + 1e-9 * (1.0 + x.abs());
        let back = transform.inverse(z);
        assert!((back - x).abs() <= 1e3 * exact, "{transform:?} {x} {back}");
    }
}

/// Rows of a length with half of its values 0, a share, a height, two categories that shift the height, some cells missing.
fn made(rows: usize, seed: u64) -> Dataset {
    let mut rng = stream(seed, "made", 0);
    let mut length = Vec::new();
    let mut share = Vec::new();
    let mut height = Vec::new();
    let mut roof = Vec::new();
    let mut wall = Vec::new();
    for i in 0..rows {
        let kind = rng.random_range(0..3);
        let stone = rng.random::<bool>();
        let z: f64 = rng.sample(StandardNormal);
        let y: f64 = rng.sample(StandardNormal);
        let seen = |v: f64, k: usize| (i % 11 != k).then_some(v);
        length.push(match kind == 0 || rng.random::<f64>() < 0.3 {
            true => seen(0.0, 1),
            false => seen((1.0 + 0.5 * kind as f64 + 0.4 * z).exp(), 1),
        });
        share.push(seen(1.0 / (1.0 + (1.5 * y).exp()), 2));
        height.push(seen(
            10.0 + 4.0 * kind as f64 + f64::from(u8::from(stone)) + 0.3 * z,
            3,
        ));
        wall.push((i % 11 != 5).then_some(stone));
        roof.push((i % 11 != 4).then_some(["flat", "gable", "hip"][kind]));
    }
    let table = Table::new()
        .real("length", length)
        .and_then(|t| t.real("share", share))
        .and_then(|t| t.real("height", height))
        .and_then(|t| t.categorical("roof", &["flat", "gable", "hip"], roof))
        .and_then(|t| t.binary("wall", wall))
        .unwrap();
    let groups = ["length", "share", "height", "roof", "wall"].map(|g| Group::new(g, &[g]));
    Dataset {
        table,
        groups: groups.to_vec(),
    }
}

fn settings() -> Settings {
    Settings {
        styles: 1..=3,
        ..Settings::default()
    }
}

#[test]
fn atoms_are_found_where_they_are_and_tables_come_back() {
    let data = made(300, 1);
    let encoding = Encoding::learn(&data, &settings().priors.linear, 1).unwrap();
    let atoms: Vec<&[f64]> = encoding.columns().iter().map(|c| &c.atoms[..]).collect();
    assert_eq!(atoms, [&[0.0][..], &[], &[]]);
    let encoded = encoding.encode(&data.table).unwrap();
    let back = encoding.decode(&encoded).unwrap();
    for column in data.table.columns() {
        let again = back.column(column.name()).unwrap();
        for row in 0..data.table.rows() {
            match (column.cell(row), again.cell(row)) {
                (Cell::Real(a), Cell::Real(b)) => assert!((a - b).abs() < 1e-9 * (1.0 + a.abs())),
                (a, b) => assert_eq!(a, b),
            }
        }
    }
    // Values that are frequent only since they were rounded are no atoms.
    let rounded = (0..400).map(|i| Some((8.0 + 2.0 * ((i as f64) * 0.61).sin()).round()));
    let table = Table::new().real("x", rounded).unwrap();
    let groups = vec![Group::new("x", &["x"])];
    let encoding = Encoding::learn(&Dataset { table, groups }, &settings().priors.linear, 1);
    assert!(encoding.unwrap().columns()[0].atoms.is_empty());
}

/// A probability at the atom, and a density elsewhere: together one.
#[test]
fn an_encoded_density_integrates_to_one() {
    let data = made(300, 2);
    let encoding = Encoding::learn(&data, &settings().priors.linear, 1).unwrap();
    let table = encoding.encode(&data.table).unwrap();
    let groups = encoding.groups(&data.groups);
    let model = learn(&table, &groups, &extended(&settings()), 1)
        .unwrap()
        .model;
    let log = |values: Vec<f64>| {
        let table = Table::new()
            .real("length", values.into_iter().map(Some))
            .unwrap();
        let logs = model
            .log_likelihood(&encoding.encode(&table).unwrap())
            .unwrap();
        let slopes = encoding.log_slopes(&table);
        logs.into_iter()
            .zip(slopes)
            .map(|(l, s)| (l + s).exp())
            .collect::<Vec<f64>>()
    };
    let step = 0.005;
    let grid = (-8_000..40_000).map(|i| (i as f64 + 0.5) * step).collect();
    let total = log(vec![0.0])[0] + step * log(grid).iter().sum::<f64>();
    assert!((total - 1.0).abs() < 2e-3, "{total}");
}

#[test]
fn categories_shift_groups_and_both_engines_agree() {
    let data = made(300, 3);
    let published = learn(&data.table, &data.groups, &settings(), 1).unwrap();
    let learned = learn(&data.table, &data.groups, &extended(&settings()), 1).unwrap();
    assert!(learned.score >= published.score - 1e-6);
    let model = learned.model;
    let edges = model.lateral_edges();
    assert!(edges.iter().any(|(from, _)| from == "roof"), "{edges:?}");

    // Written and read, and as a network.
    let text = model.to_json().unwrap();
    let again = edifice_model::hierarchy::Hierarchy::from_json(&text).unwrap();
    assert_eq!(again.to_json().unwrap(), text);
    assert!(!published.model.to_json().unwrap().contains("shifts"));
    let network = model.to_network().unwrap();
    let logs = again.log_likelihood(&data.table).unwrap();
    for (row, log) in logs.iter().enumerate() {
        let mut evidence = Evidence::new();
        for column in data.table.columns() {
            match column.cell(row) {
                Cell::Real(v) => evidence = evidence.real(column.name(), &[v]),
                Cell::Code(c) => {
                    evidence = evidence.is(column.name(), &column.categories().unwrap()[c])
                }
                Cell::Missing => {}
            }
        }
        let other = network.log_probability(&evidence).unwrap();
        assert!(
            (log - other).abs() < 1e-9 * (1.0 + log.abs()),
            "{row}: {log} {other}"
        );
    }
    // Drawn rows know the shift: a flat roof is low.
    let given = Table::new()
        .categorical("roof", &["flat", "gable", "hip"], [Some("flat")])
        .unwrap();
    let drawn = model
        .complete(&given, 400, &mut stream(1, "drawn", 0))
        .unwrap()
        .table;
    let height = drawn.column("height").unwrap();
    let mean = (0..400)
        .map(|row| match height.cell(row) {
            Cell::Real(v) => v / 400.0,
            cell => panic!("{cell:?}"),
        })
        .sum::<f64>();
    assert!((mean - 10.5).abs() < 0.3, "{mean}");
}

#[test]
fn held_out_rows_are_the_likelier_for_it() {
    let mean = |contender, train: &Dataset, test: &Dataset| {
        let losses = held_out(contender, train, test, &settings(), 1).unwrap();
        losses.iter().sum::<f64>() / losses.len() as f64
    };
    let few = mean(Contender::Extended, &made(100, 4), &made(50, 5));
    assert!(few.is_finite(), "{few}");
    // At the atom the published model has a density, of a spike of which no scale is given: it is not to be compared
    // there; on `share` and `height` alone it is.
    let without = |data: &Dataset| {
        data.without("length").map(|mut d| {
            d.table = d
                .table
                .in_order(&["share", "height", "roof", "wall"])
                .unwrap();
            d
        })
    };
    let train = without(&made(300, 4)).unwrap();
    let test = without(&made(200, 5)).unwrap();
    let [extended, ours] =
        [Contender::Extended, Contender::Ours].map(|contender| mean(contender, &train, &test));
    assert!(extended < ours - 0.05, "{extended} {ours}");
}

/// A category that shifts a group is drawn as the style asked for has it, not as all styles together have it.
#[test]
fn a_style_draws_its_own_categories() {
    let data = made(300, 3);
    let learned = learn(&data.table, &data.groups, &extended(&settings()), 1).unwrap();
    let model = learned.model;
    let edges = model.lateral_edges();
    assert!(edges.iter().any(|(from, _)| from == "roof"), "{edges:?}");
    assert!(model.styles() > 1);
    const DRAWS: usize = 20_000;
    let share = |table: &Table, rows: &[usize], category: usize| {
        let column = table.column("roof").unwrap();
        let count = rows
            .iter()
            .filter(|&&r| column.cell(r) == Cell::Code(category));
        count.count() as f64 / rows.len() as f64
    };
    let all = model.sample(DRAWS, &mut stream(1, "all", 0)).unwrap();
    let every: Vec<usize> = (0..DRAWS).collect();
    let categories = all
        .table
        .column("roof")
        .unwrap()
        .categories()
        .unwrap()
        .len();
    let mut far: f64 = 0.0;
    for style in 0..model.styles() {
        let rows: Vec<usize> = every
            .iter()
            .copied()
            .filter(|&r| all.styles[r] == style)
            .collect();
        if rows.len() < 500 {
            continue;
        }
        let own = model
            .sample_style(style, DRAWS, &mut stream(2, "style", style as u64))
            .unwrap();
        assert!(own.styles.iter().all(|&s| s == style));
        for category in 0..categories {
            let wanted = share(&all.table, &rows, category);
            let found = share(&own.table, &every, category);
            let error = (wanted * (1.0 - wanted) / rows.len() as f64).sqrt();
            assert!(
                (found - wanted).abs() < 5.0 * error + 0.01,
                "{style} {category}: {found} {wanted}"
            );
            far = far.max((wanted - share(&all.table, &every, category)).abs());
        }
    }
    // Otherwise the test could not fail.
    assert!(far > 0.1, "styles differ by {far} only");
}
