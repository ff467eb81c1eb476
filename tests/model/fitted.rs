//! `edifice model fit`: equal to the library's EM, to counts where nothing is missing, and a fixed point of EM by enumeration elsewhere.

use assert_cmd::Command;
use edifice::model::Table;
use edifice::model::network::{FitSettings, Network};
use edifice::rng::stream;
use rand::RngExt;

use crate::cases::cases;

/// A hidden cause, two of its effects, one of which depends on the other as well. The numbers only draw the data.
const NETWORK: &str = "network n {\n}
variable cause { type discrete [ 2 ] { low, high }; }
variable first { type discrete [ 3 ] { a, b, c }; }
variable second { type discrete [ 2 ] { no, yes }; }
probability ( cause ) { table 0.3, 0.7; }
probability ( first | cause ) { (low) 0.7, 0.2, 0.1; (high) 0.1, 0.3, 0.6; }
probability ( second | cause, first ) {
  (low, a) 0.9, 0.1; (high, a) 0.4, 0.6; (low, b) 0.7, 0.3; (high, b) 0.5, 0.5; (low, c) 0.2, 0.8; (high, c) 0.1, 0.9;
}
";
const NAMES: [&str; 3] = ["cause", "first", "second"];
const VALUES: [&[&str]; 3] = [&["low", "high"], &["a", "b", "c"], &["no", "yes"]];
/// Rows of a table of the network's three variables; `None` is missing.
type Rows = Vec<[Option<usize>; 3]>;

/// Draws from the network above, by hand.
fn drawn(count: usize, shown: [bool; 3], holes: f64, seed: u64) -> Rows {
    let mut rng = stream(seed, "fitted", 0);
    let mut pick = |weights: &[f64]| {
        let mut u = rng.random::<f64>();
        weights.iter().position(|w| {
            u -= w;
            u < 0.0
        })
    };
    let first = [[0.7, 0.2, 0.1], [0.1, 0.3, 0.6]];
    let second = [[0.9, 0.7, 0.2], [0.4, 0.5, 0.1]];
    let mut rows = Rows::new();
    for _ in 0..count {
        let cause = pick(&[0.3, 0.7]).unwrap_or(1);
        let a = pick(&first[cause]).unwrap_or(2);
        let no = second[cause][a];
        let values = [cause, a, pick(&[no, 1.0 - no]).unwrap_or(1)];
        rows.push([0, 1, 2].map(|j| {
            let kept = shown[j] && pick(&[holes, 1.0 - holes]) != Some(0);
            kept.then_some(values[j])
        }));
    }
    rows
}

/// The same rows as CSV, without the columns that are hidden, and as a table.
fn written(rows: &Rows, shown: [bool; 3]) -> (String, Table) {
    let columns: Vec<usize> = (0..3).filter(|&j| shown[j]).collect();
    let line = |cells: Vec<&str>| cells.join(",") + "\n";
    let mut csv = line(columns.iter().map(|&j| NAMES[j]).collect());
    for row in rows {
        let cell = |&j: &usize| row[j].map_or("NA", |v| VALUES[j][v]);
        csv += &line(columns.iter().map(cell).collect());
    }
    let mut table = Table::new();
    for j in columns {
        let codes = rows.iter().map(|row| row[j]);
        table = table.codes(NAMES[j], VALUES[j], codes).unwrap();
    }
    (csv, table)
}

/// The network that the command writes.
fn fitted(csv: &str, words: &[&str]) -> Network {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("n.bif"), NETWORK).unwrap();
    std::fs::write(folder.path().join("t.csv"), csv).unwrap();
    let mut command = Command::cargo_bin("edifice").unwrap();
    let fixed = ["model", "fit", "n.bif", "t.csv", "-o", "out.json"];
    command.args(fixed).args(words).current_dir(folder.path());
    command.assert().success();
    // The written network is read again by the program itself.
    let mut command = Command::cargo_bin("edifice").unwrap();
    let convert = ["model", "convert", "out.json", "-o", "out.bif"];
    command
        .args(convert)
        .current_dir(folder.path())
        .assert()
        .success();
    Network::from_bif(&std::fs::read_to_string(folder.path().join("out.bif")).unwrap()).unwrap()
}

fn assert_same(a: &Network, b: &Network, tolerance: f64) {
    for name in NAMES {
        let [a, b] = [a, b].map(|n| n.probabilities(name).unwrap().to_vec());
        assert_eq!(a.len(), b.len());
        let far = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
        assert!(far.fold(0.0, f64::max) <= tolerance, "{name}: {a:?} {b:?}");
    }
}

/// Entries of the three tables, `cause`, `first` by cause, `second` by cause and first, in the order of the file.
fn at(network: &Network, [cause, first, second]: [usize; 3]) -> [f64; 3] {
    let table = |name: &str| network.probabilities(name).unwrap().to_vec();
    [
        table("cause")[cause],
        table("first")[3 * cause + first],
        table("second")[2 * (3 * cause + first) + second],
    ]
}

/// One more round of EM by enumeration of all twelve states: the greatest change of an entry.
fn change_of_a_round(network: &Network, rows: &Rows, alpha: f64) -> f64 {
    let states: Vec<[usize; 3]> = (0..12).map(|s| [s / 6, s / 2 % 3, s % 2]).collect();
    let mut counts = [0.0; 12];
    for row in rows {
        let fits = |s: &[usize; 3]| (0..3).all(|j| row[j].is_none_or(|v| v == s[j]));
        let weights = states.iter().map(|s| match fits(s) {
            true => at(network, *s).iter().product(),
            false => 0.0,
        });
        let weights: Vec<f64> = weights.collect();
        let sum: f64 = weights.iter().sum();
        for (count, w) in counts.iter_mut().zip(&weights) {
            *count += w / sum;
        }
    }
    let sum_where = |fits: &dyn Fn(&[usize; 3]) -> bool| -> f64 {
        let all = states.iter().zip(&counts).filter(|(s, _)| fits(s));
        all.map(|(_, c)| c).sum()
    };
    let more = alpha - 1.0;
    let mut most: f64 = 0.0;
    for s in &states {
        let [c, f, x] = *s;
        let entries = [
            (sum_where(&|t| t[0] == c), rows.len() as f64, 2.0),
            (
                sum_where(&|t| t[..2] == [c, f]),
                sum_where(&|t| t[0] == c),
                3.0,
            ),
            (
                sum_where(&|t| *t == [c, f, x]),
                sum_where(&|t| t[..2] == [c, f]),
                2.0,
            ),
        ];
        for ((count, all, k), now) in entries.into_iter().zip(at(network, *s)) {
            most = most.max(((count + more) / (all + k * more) - now).abs());
        }
    }
    most
}

#[test]
fn the_command_is_the_librarys_em() {
    let open = Network::from_bif(NETWORK).unwrap();
    let settings = FitSettings::default();
    let alpha = settings.priors.dirichlet;
    let all = [
        (1, [true; 3], 0.0),
        (4, [false, true, true], 0.2),
        (2, [true; 3], 0.3),
        (3, [false, true, true], 0.0),
        (5, [true, false, true], 0.1),
    ];
    for (seed, shown, holes) in all.into_iter().take(cases(all.len())) {
        let rows = drawn(160, shown, holes, seed);
        let (csv, table) = written(&rows, shown);
        let own = open
            .fit(&table, &settings, &mut stream(1, "model/fit", 0))
            .unwrap();
        let command = fitted(&csv, &[]);
        assert_same(&command, &own.network, 1e-9);
        let from = open.fit_from(&table, &settings).unwrap();
        assert_same(&fitted(&csv, &["--from"]), &from.network, 1e-9);
        // EM stops where a round gains little, so that a hidden cause may move a little more; counts are exact at once.
        let most = if shown == [true; 3] && holes == 0.0 {
            1e-9
        } else {
            2e-3
        };
        let change = change_of_a_round(&command, &rows, alpha);
        assert!(change <= most, "{seed}: {change}");
    }
}
