//! Long calls that are stopped in the middle, from another thread: each returns the best so far within 0.2 s of processor time.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use cpu_time::ThreadTime;
use edifice::grammar::{Costs, evaluate};
use edifice::io::city;
use edifice::methods::city_proceduralization::{self, proceduralize};
use edifice::methods::facade_grammar::{self, infer};
use edifice::methods::structure_completion::layout::{Class, Element, Layout};
use edifice::methods::structure_completion::model::Model;
use edifice::model::Table;
use edifice::model::network::structure::{Score, SearchSettings, score, search, search_while};
use edifice::rng::stream;
use edifice::shape::{Facade, Rect, Region};
use edifice::{Ended, Progress, Watch, unwatched};
use edifice_editing::examples::example;
use edifice_editing::work::Work;
use edifice_experiments::studies;
use edifice_experiments::sweep::Plan;
use edifice_experiments::sweep::run::{Wanted, run};
use rand::RngExt;

/// Processor time from a stop to the return, at most.
const PATIENCE: Duration = Duration::from_millis(200);

/// Runs a method on one thread. Another thread stops it once it has asked its watch so often; the watch waits for that, however late the
/// other thread gets its turn. The processor time that the method takes from then on is at most that since it asked last before.
fn stopped<T: Send>(after: usize, method: impl FnOnce(&Watch) -> T + Send) -> T {
    let (asked, stop, over) = (
        AtomicUsize::new(0),
        AtomicBool::new(false),
        AtomicBool::new(false),
    );
    let last = Mutex::new(Duration::ZERO);
    let clock = || ThreadTime::now().as_duration();
    // All work of the method is done on this one thread.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let (found, took) = std::thread::scope(|scope| {
        scope.spawn(|| {
            while asked.load(Ordering::Relaxed) < after && !over.load(Ordering::Relaxed) {
                std::thread::sleep(Duration::from_micros(100));
            }
            stop.store(true, Ordering::Relaxed);
        });
        pool.expect("a pool").install(|| {
            let watch = |_: Progress| {
                if asked.fetch_add(1, Ordering::Relaxed) + 1 >= after {
                    while !stop.load(Ordering::Relaxed) {
                        std::thread::sleep(Duration::from_micros(100));
                    }
                    return ControlFlow::Break(());
                }
                *last.lock().expect("one thread") = clock();
                ControlFlow::Continue(())
            };
            let found = method(&watch);
            over.store(true, Ordering::Relaxed);
            let last = *last.lock().expect("one thread");
            (found, clock().saturating_sub(last))
        })
    });
    assert!(took <= PATIENCE, "{took:?} after it was asked for {after}");
    found
}

/// A facade whose grammar takes long.
fn chequered() -> Facade {
    let labels = ["wall", "window", "door", "balcony"];
    let cells = (0..14 * 17).map(|k| (k / 17, k % 17));
    let regions = cells.map(|(row, column): (usize, usize)| Region {
        label: labels[(row * row + 3 * column * column + row * column) % 4].into(),
        rect: Rect::new(column as f64, row as f64, 1.0, 1.0),
    });
    Facade {
        name: "chequered".into(),
        unit: "m".into(),
        width: 17.0,
        height: 14.0,
        regions: regions.collect(),
    }
}

#[test]
fn grammar_inference() {
    let (facades, costs) = ([chequered()], Costs::default());
    let settings = facade_grammar::Settings {
        iterations: 2_500,
        ..Default::default()
    };
    let found = |after| {
        stopped(after, |watch| {
            infer(&facades, &settings, watch).expect("ends")
        })
    };
    // In the rules of all regions, in the bound, and beyond it.
    for after in [1, 300, 3_000, 5_000] {
        let found = found(after);
        let cost = evaluate(&found.grammar, &facades, &costs)
            .expect("derives it")
            .cost;
        assert_eq!(found.ended, Ended::Interrupted);
        let lower = found.lower_bound.expect("a bound");
        assert!(lower > 0.0 && lower <= cost + 1e-6, "{lower} {cost}");
    }
    let joint = [
        facades[0].clone(),
        Facade {
            name: "again".into(),
            ..chequered()
        },
    ];
    let found = stopped(2_000, |watch| {
        infer(&joint, &settings, watch).expect("ends")
    });
    assert_eq!(found.ended, Ended::Interrupted);
    evaluate(&found.grammar, &joint, &costs).expect("derives both");
}

/// Columns of two categories, each like the one before.
fn chain(columns: usize, rows: usize) -> Table {
    let mut rng = stream(1, "stopping", 0);
    let mut table = Table::new();
    let mut last: Vec<bool> = (0..rows).map(|_| rng.random()).collect();
    for column in 0..columns {
        for bit in &mut last {
            *bit ^= rng.random_bool(0.2);
        }
        let bits = last.iter().copied().map(Some).collect::<Vec<_>>();
        table = table.binary(&format!("x{column}"), bits).expect("a column");
    }
    table
}

#[test]
fn structure_search() {
    let data = chain(30, 1_000);
    let whole = search(&data, &SearchSettings::default(), 1).expect("a structure");
    assert!(!whole.interrupted);
    for after in [2, 10, 30] {
        let found = stopped(after, |watch| {
            let goes_on = || watch(Progress::stage("moves")).is_continue();
            search_while(&data, &SearchSettings::default(), 1, &goes_on).expect("ends")
        });
        assert!(found.interrupted);
        assert!(found.score <= whole.score && found.moves <= whole.moves);
        // Its score is that of its edges.
        let index = |name: &str| name[1..].parse::<usize>().expect("a number");
        let mut parents = vec![Vec::new(); 30];
        for (parent, child) in &found.edges {
            parents[index(child)].push(index(parent));
        }
        let again = score(&data, &parents, Score::Bdeu(1.0)).expect("a score");
        assert!((again - found.score).abs() < 1e-6);
    }
}

/// A facade of windows in columns and rows.
fn windows(columns: usize, rows: usize) -> Layout {
    let cells = (0..columns * rows).map(|k| (k % columns, k / columns));
    let window = |(c, r): (usize, usize)| {
        let rect = Rect::new(8.0 + 25.0 * c as f64, 10.0 + 30.0 * r as f64, 10.0, 16.0);
        Element::new(Class::Window, rect)
    };
    Layout {
        name: format!("{columns}x{rows}"),
        width: 1.0 + 25.0 * columns as f64,
        height: 6.0 + 30.0 * rows as f64,
        elements: cells.map(window).collect(),
    }
}

#[test]
fn completion_training() {
    let layouts: Vec<Layout> = (0..16).map(|k| windows(3 + k % 5, 2 + k / 4)).collect();
    // While parts are hidden, while trees are grown, and in the weights of the paper's method.
    for (after, elements, paper) in [(20, true, false), (180, true, false), (700, true, true)] {
        let found = stopped(after, |watch| {
            Model::train(layouts.clone(), 1, watch).expect("a model")
        });
        assert_eq!(found.ended, Ended::Interrupted);
        assert_eq!(found.model.elements.is_some(), elements, "{after}");
        assert_eq!(found.model.paper.is_some(), paper, "{after}");
        assert_eq!(found.model.examples.len(), layouts.len());
    }
}

#[test]
fn proceduralization() {
    let town = example("town", &Work::default()).expect("ships");
    let bytes = town.export("obj").expect("a city");
    let city = city::obj::parse(&bytes, Path::new("town.obj")).expect("a city");
    let settings = city_proceduralization::Settings::default();
    let whole = proceduralize(&city, &settings, &unwatched).expect("a grammar");
    assert_eq!(whole.ended, Ended::Finished);
    let buildings = city.buildings.len();
    for after in [2, buildings / 2, buildings] {
        let found = stopped(after, |watch| {
            proceduralize(&city, &settings, watch).expect("a grammar")
        });
        assert_eq!(found.ended, Ended::Interrupted);
        let cut = found.decomposition.components.len();
        assert!(cut > 0 && cut <= whole.decomposition.components.len());
        // What was cut until then is derived again.
        assert!(!found.grammar.templates.is_empty());
    }
}

#[test]
fn sweep() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let facade = edifice::io::facade_json::to_string(&chequered());
    std::fs::write(at("chequered.facade.json"), facade).expect("a file");
    let text = "study = \"facade_grammar/infer\"\ndata = [\"FILE\"]\nseeds = 2\n[base]\niterations = 100\n[[arm]]\nname = \"own\"\n";
    let text = text.replace("FILE", &at("chequered.facade.json").to_string_lossy());
    std::fs::write(at("sweep.toml"), text).expect("a file");
    let studies = studies();
    let plan =
        Plan::make(&at("sweep.toml"), folder.path(), &studies).unwrap_or_else(|e| panic!("{e}"));
    let study = plan.study(&studies).expect("a study");
    let go = |watch: &Watch| run(&plan, folder.path(), study, (0, 1), Wanted::Missing, watch);
    let ran = stopped(50, |watch| go(watch).expect("ends"));
    assert_eq!(
        (ran.ended, ran.finished, ran.failed),
        (Ended::Interrupted, 0, 0)
    );
    // What was given up is run again.
    let ran = go(&unwatched).expect("runs");
    assert_eq!(
        (ran.ended, ran.finished, ran.before),
        (Ended::Finished, 2, 0)
    );
}
