//! Cities as grammars: fixed points, order, threads, dirty meshes, recovery.

use std::path::Path;

use std::collections::BTreeSet;

use edifice::cluster::adjusted_rand_index;
use edifice::grammar::instance::{
    InstanceGrammar, InstanceGrammarError, InstanceRule, Placement, Template,
};
use edifice::io::city::grammar_json;
use edifice::methods::city_proceduralization::{
    Budget, Mode, Settings, Structure, decompose, proceduralize,
};
use edifice::shape::triangles::{City, TriangleMesh, VolumeRaster};
use edifice::unwatched;
use edifice_generators_city_proceduralization as synthetic;

pub(super) fn settings(mode: Mode, budget: Budget) -> Settings {
    Settings {
        mode,
        budget,
        ..Settings::default()
    }
}

pub(super) fn derived(city: &City, settings: &Settings) -> (City, InstanceGrammar) {
    let made = proceduralize(city, settings, &unwatched).unwrap();
    (
        made.grammar.derive().unwrap().city(&made.grammar),
        made.grammar,
    )
}

pub(super) fn iou(a: &City, b: &City) -> f64 {
    let [a, b]: [Vec<&TriangleMesh>; 2] =
        [a, b].map(|c| c.buildings.iter().map(|b| &b.mesh).collect());
    VolumeRaster { size: 0.5 }.compare(&a, &b).iou()
}

#[test]
fn deriving_what_was_made_gives_the_city_back() {
    let (city, _) = synthetic::city(12, 0.02, 1);
    let (first, _) = derived(&city, &settings(Mode::Best, Budget::All));
    assert!(iou(&city, &first) > 0.995, "{}", iou(&city, &first));
    // And once more: a fixed point.
    let (second, grammar) = derived(&first, &settings(Mode::Best, Budget::All));
    assert!(iou(&first, &second) > 0.995, "{}", iou(&first, &second));
    let (_, again) = derived(&second, &settings(Mode::Best, Budget::All));
    assert_eq!(again.rules, grammar.rules);
    let ids = |c: &City| {
        c.buildings
            .iter()
            .map(|b| b.id.clone())
            .collect::<BTreeSet<_>>()
    };
    assert_eq!(ids(&city), ids(&second));
    let (paper, _) = derived(&city, &settings(Mode::Paper, Budget::Level(0)));
    assert!(iou(&city, &paper) > 0.97, "{}", iou(&city, &paper));
}

#[test]
fn more_templates_are_no_worse_and_best_beats_paper() {
    let (city, _) = synthetic::city(20, 0.03, 2);
    let mut last = 0.0;
    for k in [3, 12, 48, 120] {
        let best = iou(
            &city,
            &derived(&city, &settings(Mode::Best, Budget::Templates(k))).0,
        );
        let paper = iou(
            &city,
            &derived(&city, &settings(Mode::Paper, Budget::Templates(k))).0,
        );
        assert!(best >= last - 0.005, "{k}: {best} after {last}");
        assert!(best > paper, "{k}: {best} {paper}");
        last = best;
    }
}

#[test]
fn threads_do_not_matter() {
    let (city, _) = synthetic::city(10, 0.03, 3);
    for mode in [Mode::Best, Mode::Paper] {
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            let made = pool.install(|| {
                proceduralize(&city, &settings(mode, Budget::Level(2)), &unwatched).unwrap()
            });
            grammar_json::to_string(&made.grammar).unwrap()
        };
        let one = run(1);
        assert!(one == run(2) && one == run(8), "{mode:?}");
    }
}

#[test]
fn the_order_of_buildings_changes_no_volume() {
    let (city, _) = synthetic::city(10, 0.03, 4);
    let mut other = city.clone();
    other.buildings.reverse();
    let run = |c: &City| derived(c, &settings(Mode::Best, Budget::Level(2))).0;
    let (a, b) = (run(&city), run(&other));
    let (x, y) = (iou(&city, &a), iou(&city, &b));
    assert!((x - y).abs() < 0.005, "{x} {y}");
}

#[test]
fn inverted_opened_and_doubled_meshes_cost_little() {
    let (city, _) = synthetic::city(10, 0.02, 5);
    let s = settings(Mode::Best, Budget::Level(2));
    let clean = iou(&city, &derived(&city, &s).0);
    let dirty = |change: &dyn Fn(&mut TriangleMesh)| {
        let mut copy = city.clone();
        copy.buildings.iter_mut().for_each(|b| change(&mut b.mesh));
        iou(&city, &derived(&copy, &s).0)
    };
    let open = |m: &mut TriangleMesh| {
        // Without its bottom.
        let low = m.bounds().unwrap().0[2];
        let positions = m.positions.clone();
        m.triangles
            .retain(|t| t.iter().any(|&i| positions[i as usize][2] > low + 0.1));
    };
    let double = |m: &mut TriangleMesh| m.append(&m.clone());
    for (name, found) in [
        ("inverted", dirty(&TriangleMesh::flip)),
        ("opened", dirty(&open)),
        ("doubled", dirty(&double)),
    ] {
        assert!((found - clean).abs() < 0.005, "{name}: {found} {clean}");
    }
}

#[test]
fn cuts_of_a_known_grammar_are_found() {
    let (city, truth) = synthetic::city(40, 0.0, 6);
    let made = decompose(&city, true, &unwatched);
    let mut wrong = 0;
    for (b, t) in truth.iter().enumerate() {
        let own = made.components.iter().filter(|c| c.building == b).skip(1);
        let found: Vec<f64> = own.map(|c| c.frame.base[2]).collect();
        let close = found.len() == t.cuts.len()
            && found.iter().zip(&t.cuts).all(|(a, b)| (a - b).abs() < 0.01);
        wrong += usize::from(!close);
    }
    assert_eq!(wrong, 0, "of {}", truth.len());
}

#[test]
fn types_and_motifs_of_a_known_grammar_are_found() {
    for (noise, least) in [(0.0, 0.99), (0.03, 0.95)] {
        let (city, truth) = synthetic::city(160, noise, 9);
        let made =
            proceduralize(&city, &settings(Mode::Best, Budget::Level(4)), &unwatched).unwrap();
        let Structure::Patterns {
            buildings,
            patterns,
        } = &made.structure
        else {
            panic!("no patterns");
        };
        let found: Vec<usize> = buildings.labels.iter().map(|l| l.unwrap()).collect();
        let kinds: Vec<usize> = truth.iter().map(|t| t.kind).collect();
        let agreement = adjusted_rand_index(&found, &kinds);
        assert!(agreement >= least, "noise {noise}: {agreement}");
        if noise == 0.0 {
            // Each motif is one rule of its six types, as often as the city has it.
            let mut motifs: Vec<Vec<usize>> = Vec::new();
            for p in patterns {
                let kind = |l: usize| kinds[found.iter().position(|&f| f == l).unwrap()];
                let mut own: Vec<usize> = p.members.iter().map(|m| kind(m.kind)).collect();
                own.sort_unstable();
                let count = kinds.iter().filter(|&&k| k == own[0]).count();
                assert_eq!(p.count, count);
                motifs.push(own);
            }
            motifs.sort();
            let expected: Vec<Vec<usize>> = (0..synthetic::MOTIFS)
                .map(|m| (6 * m..6 * m + 6).collect())
                .collect();
            assert_eq!(motifs, expected);
        }
    }
}

#[test]
fn parts_of_another_template_are_placed() {
    let mut grammar = by_hand();
    let mut other = grammar.templates[0].clone();
    other.symbol = "T2".to_owned();
    grammar.templates.push(other);
    let part = grammar.rules[0].successors[1].parts[0].as_mut().unwrap();
    part.symbol = "T2".to_owned();
    assert_eq!(grammar.derive().unwrap().instances[2].template, 1);
    // But not of a rule.
    let part = grammar.rules[0].successors[1].parts[0].as_mut().unwrap();
    part.symbol = "H".to_owned();
    let error = grammar.derive().unwrap_err();
    assert!(
        matches!(error, InstanceGrammarError::Part { .. }),
        "{error}"
    );
}

/// A grammar by hand: a block, and a house of two blocks of which one instance lacks the second.
pub(super) fn by_hand() -> InstanceGrammar {
    let mut block = TriangleMesh::default();
    block.push([[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 1.0]]);
    let rule = |symbol: &str, successors| InstanceRule::new(symbol, 1.0, successors);
    let two = vec![
        Placement::new("T1", [0.0; 3], 0.0, [4.0, 2.0, 3.0]),
        Placement::new("T1", [1.0, 0.0, 3.0], 90.0, [2.0; 3]),
    ];
    let mut house = Placement::new("H", [10.0, 0.0, 0.0], 90.0, [2.0; 3]);
    house.id = Some("a \"b\"".to_owned());
    house.attributes.insert("year".to_owned(), 1931.into());
    let mut half = Placement::new("H", [0.0; 3], 0.0, [1.0; 3]);
    half.parts = vec![
        Some(Placement::new("T1", [5.0, 0.0, 0.0], 0.0, [1.0; 3])),
        None,
    ];
    InstanceGrammar {
        name: "by hand".to_owned(),
        reference_system: Some("EPSG:7415".to_owned()),
        origin: [1e5, 2.5e5, 0.0],
        axiom: "City".to_owned(),
        templates: vec![Template {
            symbol: "T1".to_owned(),
            mesh: block,
            texture: None,
        }],
        rules: vec![rule("City", vec![house, half]), rule("H", two)],
    }
}

#[test]
fn a_grammar_by_hand_derives_as_computed() {
    let derivation = by_hand().derive().unwrap();
    assert_eq!((derivation.instances.len(), derivation.depth), (3, 2));
    let second = &derivation.instances[1];
    // Scaled by 2, turned by 90 degrees, shifted by 10.
    let close = |a: [f64; 3], b: [f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-12);
    assert!(close(second.at, [10.0, 2.0, 6.0]), "{:?}", second.at);
    assert!(close(second.size, [4.0; 3]) && second.turn == 180.0);
    assert_eq!(derivation.instances[2].at, [5.0, 0.0, 0.0]);
    assert_eq!(derivation.instances[2].building, None);
}

#[test]
fn grammars_are_read_as_written() {
    let path: &Path = "g.city-grammar.json".as_ref();
    let grammar = by_hand();
    let text = grammar_json::to_string(&grammar).unwrap();
    assert_eq!(grammar_json::parse(text.as_bytes(), path).unwrap(), grammar);
    let (city, _) = synthetic::city(6, 0.02, 7);
    for mode in [Mode::Best, Mode::Paper] {
        let (_, grammar) = derived(&city, &settings(mode, Budget::Level(2)));
        let text = grammar_json::to_string(&grammar).unwrap();
        let again = grammar_json::parse(text.as_bytes(), path).unwrap();
        assert_eq!(grammar_json::to_string(&again).unwrap(), text);
    }
}

#[test]
fn unsound_grammars_are_refused() {
    let fault = |change: &dyn Fn(&mut InstanceGrammar)| {
        let mut grammar = by_hand();
        change(&mut grammar);
        grammar.derive().unwrap_err()
    };
    let cyclic = fault(&|g| {
        g.rules[1].successors[0] = Placement::new("City", [0.0; 3], 0.0, [1.0; 3]);
    });
    assert!(
        matches!(cyclic, InstanceGrammarError::Cyclic(_)),
        "{cyclic}"
    );
    let unknown = fault(&|g| g.rules[1].successors[0].symbol = "X".to_owned());
    assert!(
        unknown.to_string().contains("rules[1].successors[0]"),
        "{unknown}"
    );
    let number = fault(&|g| g.rules[0].successors[0].turn = f64::NAN);
    assert!(
        matches!(number, InstanceGrammarError::Number { .. }),
        "{number}"
    );
    let shear = fault(&|g| g.rules[0].successors[0].size = [1.0, 2.0, 1.0]);
    assert!(
        matches!(shear, InstanceGrammarError::Number { .. }),
        "{shear}"
    );
    let parts = fault(&|g| g.rules[0].successors[1].parts.push(None));
    assert!(
        matches!(parts, InstanceGrammarError::Parts { .. }),
        "{parts}"
    );
    let index = fault(&|g| g.templates[0].mesh.triangles[0][0] = 9);
    assert!(
        matches!(index, InstanceGrammarError::Dangling { .. }),
        "{index}"
    );
    let axiom = fault(&|g| g.axiom = "T1".to_owned());
    assert!(matches!(axiom, InstanceGrammarError::NoAxiom(_)), "{axiom}");
}
