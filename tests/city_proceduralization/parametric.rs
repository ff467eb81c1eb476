//! Rules with parameters: what they compute, what is left of a city by the rules alone, and what an edit of a type moves.

use std::collections::BTreeSet;
use std::path::Path;

use edifice::grammar::instance::{
    Grid, InstanceGrammar, InstanceRule, Placement, Template, TemplateInstance,
};
use edifice::io::city::{compact, grammar_json};
use edifice::methods::city_proceduralization::arrangement::arrange;
use edifice::methods::city_proceduralization::{Budget, Precision, Settings, proceduralize};
use edifice::shape::triangles::{City, TriangleMesh, VolumeRaster};
use edifice::unwatched;
use edifice_editing::city_proceduralization::{CityEdit, edit};
use edifice_generators_city_proceduralization as synthetic;

fn made(city: &City, budget: Budget) -> InstanceGrammar {
    let settings = Settings {
        budget,
        ..Settings::default()
    };
    proceduralize(city, &settings, &unwatched).unwrap().grammar
}

fn derived(grammar: &InstanceGrammar) -> City {
    grammar.derive().unwrap().city(grammar)
}

fn iou(a: &City, b: &City) -> f64 {
    let [a, b]: [Vec<&TriangleMesh>; 2] =
        [a, b].map(|c| c.buildings.iter().map(|b| &b.mesh).collect());
    VolumeRaster { size: 0.5 }.compare(&a, &b).iou()
}

fn volume(city: &City) -> f64 {
    let own = |m: &TriangleMesh| m.volume_above(m.bounds().unwrap().0[2]).abs();
    city.buildings.iter().map(|b| own(&b.mesh)).sum()
}

#[test]
fn parts_follow_the_numbers() {
    let mut rule = InstanceRule::new(
        "B1",
        1.0,
        vec![
            Placement::new("T1", [0.0; 3], 0.0, [1.0; 3]),
            Placement::new("T2", [0.25, -0.1, 1.0], 90.0, [0.5, 0.25, 0.5]),
        ],
    );
    rule.levels = 2;
    let numbers = [20.0, 10.0, 6.0, 4.0];
    let [body, roof] = [0, 1].map(|k| rule.part(k, &numbers));
    assert_eq!((body.at, body.size), ([0.0; 3], [20.0, 10.0, 6.0]));
    // Turned by a quarter, its width lies along the depth of the building.
    assert_eq!((roof.at, roof.size), ([5.0, -1.0, 6.0], [5.0, 5.0, 2.0]));
    rule.scale = [2.0, 1.0, 1.5];
    let scaled = rule.scaled(&roof);
    assert_eq!(scaled.at, [10.0, -1.0, 9.0]);
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
    assert!(near(scaled.size[0], 5.0) && near(scaled.size[1], 10.0) && near(scaled.size[2], 3.0));
    let plain = InstanceRule::new(
        "N",
        1.0,
        vec![Placement::new("T1", [1.0; 3], 3.0, [2.0; 3])],
    );
    assert_eq!(plain.part(0, &[]), plain.successors[0]);
}

#[test]
fn numbers_that_do_not_fit_the_rule_are_refused() {
    let mut mesh = TriangleMesh::default();
    mesh.push([[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 1.0]]);
    let mut rule = InstanceRule::new(
        "B",
        1.0,
        vec![Placement::new("T1", [0.0; 3], 0.0, [1.0; 3])],
    );
    rule.levels = 1;
    let mut placed = Placement::new("B", [0.0; 3], 0.0, [1.0; 3]);
    placed.numbers = vec![4.0, 3.0, 2.0];
    let grammar = InstanceGrammar {
        axiom: "City".into(),
        templates: vec![Template {
            symbol: "T1".into(),
            mesh,
            texture: None,
        }],
        rules: vec![InstanceRule::new("City", 1.0, vec![placed]), rule],
        ..InstanceGrammar::default()
    };
    assert_eq!(grammar.derive().unwrap().instances[0].size, [4.0, 3.0, 2.0]);
    let text = grammar_json::to_string(&grammar).unwrap();
    assert!(
        text.contains("\"parameters\":[\"w\",\"d\",\"h1\"]"),
        "{text}"
    );
    let path = std::path::Path::new("g.city-grammar.json");
    assert_eq!(grammar_json::parse(text.as_bytes(), path).unwrap(), grammar);
    let fault = |change: &dyn Fn(&mut InstanceGrammar)| {
        let mut g = grammar.clone();
        change(&mut g);
        g.derive().unwrap_err().to_string()
    };
    let few = fault(&|g| g.rules[0].successors[0].numbers.truncate(2));
    assert!(
        few.contains("2 numbers") && few.contains("3 parameters"),
        "{few}"
    );
    let none = fault(&|g| g.rules[0].successors[0].numbers[1] = 0.0);
    assert!(none.contains("numbers[1]"), "{none}");
    let high = fault(&|g| g.rules[1].successors[0].at[2] = 1.0);
    assert!(high.contains("level"), "{high}");
    let factor = fault(&|g| g.rules[1].scale[0] = f64::NAN);
    assert!(factor.contains("scale"), "{factor}");
    let nested = fault(&|g| {
        g.rules[0].levels = 1;
        g.rules[0].successors[0].at[2] = 0.0;
    });
    assert!(nested.contains("templates only"), "{nested}");
}

#[test]
fn a_city_of_a_known_grammar_is_derived_by_the_rules_alone() {
    for (noise, least) in [(0.0, 0.99), (0.03, 0.97)] {
        let (city, _) = synthetic::city(40, noise, 3);
        let grammar = made(&city, Budget::Templates(110));
        let rules = grammar.rules_only();
        assert_eq!(rules.residuals(), 0);
        let found = iou(&city, &derived(&rules));
        println!(
            "noise {noise}: {found:.4}, {} residuals of {}",
            grammar.residuals(),
            city.buildings.len()
        );
        assert!(found >= least, "noise {noise}: {found}");
        // With residuals nothing is lost.
        assert!(iou(&city, &derived(&grammar)) >= found - 0.002);
    }
}

#[test]
fn residuals_stand_in_a_stream_of_their_own() {
    let (city, _) = synthetic::city(20, 0.05, 5);
    let settings = Settings {
        budget: Budget::Level(4),
        precision: Some(Precision::Decimetre),
        ..Settings::default()
    };
    let grammar = proceduralize(&city, &settings, &unwatched).unwrap().grammar;
    assert!(grammar.residuals() > 0);
    let bytes = compact::to_bytes(&grammar).unwrap();
    let again = compact::from_bytes(&bytes).unwrap();
    assert_eq!(again.residuals(), grammar.residuals());
    let part = |at: usize| {
        let size = u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        at + 4 + size
    };
    let residuals = bytes.len() - part(part(10));
    let without = compact::to_bytes(&again.rules_only()).unwrap();
    println!(
        "{} bytes, {residuals} of residuals, {} without",
        bytes.len(),
        without.len()
    );
    assert!(residuals > 0 && bytes.len() - without.len() >= residuals / 2);
}

#[test]
fn edits_of_types_scale_what_they_name() {
    let (city, _) = synthetic::city(30, 0.03, 7);
    let grammar = made(&city, Budget::Level(3));
    let before = volume(&derived(&grammar));
    let edits = |texts: &[&str]| texts.iter().map(|t| t.parse().unwrap()).collect::<Vec<_>>();
    let all = edits(&["scale B*=1,1,1.5", "scale E*=1,1,1.5"]);
    let kinds = |g: &InstanceGrammar, start: &str| {
        g.rules
            .iter()
            .any(|r| r.symbol.starts_with(start) && r.levels > 0)
    };
    let all: Vec<_> = match kinds(&grammar, "E") {
        true => all,
        false => all[..1].to_vec(),
    };
    for carry in [true, false] {
        let taller = edit(&grammar, &all, carry).unwrap();
        let base = match carry {
            true => before,
            false => volume(&derived(&grammar.rules_only())),
        };
        let after = volume(&derived(&taller));
        assert!(
            (after / base - 1.5).abs() < 0.005,
            "{carry}: {after} {base}"
        );
        // Buildings stay where they stand.
        let low = |c: &City| c.buildings[5].mesh.bounds().unwrap().0;
        assert!((low(&derived(&taller))[2] - low(&derived(&grammar))[2]).abs() < 0.02);
    }
    // One type moves all of its instances, and no others.
    let first = grammar
        .rules
        .iter()
        .find(|r| r.levels > 0)
        .unwrap()
        .symbol
        .clone();
    let wider = edit(&grammar, &edits(&[&format!("scale {first}=2,1,1")]), true).unwrap();
    let (a, b) = (derived(&grammar), derived(&wider));
    let axiom = &grammar.flat(None).rules[0].successors;
    for (k, placed) in axiom.iter().enumerate() {
        let ratio = volume(&single(&b, k)) / volume(&single(&a, k));
        let expected = if placed.symbol == first { 2.0 } else { 1.0 };
        assert!((ratio - expected).abs() < 0.02, "{} {ratio}", placed.symbol);
    }
    assert!(edit(&grammar, &edits(&["scale Q7=1,1,2"]), true).is_err());
}

/// The building of a placed template, its place and its turn.
type Stands = (String, ([f64; 3], f64));

#[test]
fn blocks_and_rows_are_moved_turned_and_taken_away() {
    let (city, _) = synthetic::city(30, 0.03, 7);
    let grammar = made(&city, Budget::Level(3));
    let block = (grammar.rules.iter())
        .find(|r| r.symbol.starts_with('K'))
        .unwrap();
    let apply = |text: &str| {
        let asked: CityEdit = text.parse().ok()?;
        edit(&grammar, &[asked], true).ok()
    };
    let places = |g: &InstanceGrammar| {
        let derivation = g.derive().unwrap();
        let of = |i: &TemplateInstance| {
            let id = i.building.map(|b| derivation.buildings[b].0.clone());
            (id.unwrap(), (i.at, i.turn))
        };
        derivation.instances.iter().map(of).collect::<Vec<_>>()
    };
    let before = places(&grammar);
    // Moved: those of the block, by as much, and no others.
    let inside = {
        let mut only = grammar.clone();
        only.axiom.clone_from(&block.symbol);
        let all = places(&only);
        all.into_iter().map(|p| p.0).collect::<BTreeSet<_>>()
    };
    let moved = places(&apply(&format!("move {}=10,-4,1", block.symbol)).unwrap());
    for ((id, (a, _)), (other, (b, _))) in before.iter().zip(&moved) {
        let expected = if inside.contains(id) {
            [10.0, -4.0, 1.0]
        } else {
            [0.0; 3]
        };
        assert_eq!(id, other);
        assert!(
            (0..3).all(|k| (b[k] - a[k] - expected[k]).abs() < 1e-9),
            "{id}"
        );
    }
    // Turned by a full circle it stands where it stood, by a right angle it does not.
    let turned =
        |degrees: &str| places(&apply(&format!("turn {}={degrees}", block.symbol)).unwrap());
    let apart = |found: &[Stands]| {
        let far = |(a, b): (&Stands, &Stands)| (a.1.0[0] - b.1.0[0]).hypot(a.1.0[1] - b.1.0[1]);
        before.iter().zip(found).map(far).fold(0.0, f64::max)
    };
    assert!(apart(&turned("360")) < 1e-6 && apart(&turned("90")) > 3.0);
    // Taken away: a block with its buildings, a type wherever it stands, residuals with their parts.
    let less = places(&apply(&format!("remove {}", block.symbol)).unwrap());
    let ids = |all: &[Stands]| all.iter().map(|p| p.0.clone()).collect::<BTreeSet<_>>();
    let left: BTreeSet<String> = ids(&before).difference(&inside).cloned().collect();
    assert_eq!(ids(&less), left);
    let flat = grammar.flat(None);
    let kind = &flat.rules[0].successors[0].symbol;
    let of_kind = (flat.rules[0].successors.iter()).filter(|s| s.symbol == *kind);
    let none = apply(&format!("remove {kind}")).unwrap();
    assert_eq!(
        ids(&places(&none)).len(),
        ids(&before).len() - of_kind.count()
    );
    assert!(apply("remove T1").is_some());
    for text in [
        "move B1=1,0,0",
        "turn Q1=3",
        "remove Q1",
        "remove City",
        "turn K1=inf",
    ] {
        assert!(apply(text).is_none(), "{text}");
    }
}

#[test]
fn a_row_closes_up_and_makes_room() {
    let cube = Template {
        symbol: "T1".to_owned(),
        mesh: TriangleMesh::default(),
        texture: None,
    };
    let house = |k: usize| {
        let kind = if k == 2 { "B2" } else { "B1" };
        let mut placed = Placement::new(kind, [6.0 * k as f64, 1.0, 0.0], 0.0, [1.0; 3]);
        placed.numbers = vec![6.0, 9.0, 6.0];
        placed.id = Some(format!("b{k}"));
        placed
    };
    let kind = |symbol: &str| InstanceRule {
        levels: 1,
        ..InstanceRule::new(
            symbol,
            1.0,
            vec![Placement::new("T1", [0.0; 3], 0.0, [1.0; 3])],
        )
    };
    let houses = (0..5).map(house).collect();
    let flat = InstanceGrammar {
        axiom: "City".to_owned(),
        templates: vec![cube],
        rules: vec![
            InstanceRule::new("City", 1.0, houses),
            kind("B1"),
            kind("B2"),
        ],
        ..InstanceGrammar::default()
    };
    let grid = Grid {
        length: 100.0,
        turn: 100.0,
    };
    let street = arrange(&flat, &grid);
    let along = |text: &str| -> Vec<f64> {
        let edited = edit(&street, &[text.parse().unwrap()], true).unwrap();
        let instances = edited.derive().unwrap().instances;
        instances.iter().map(|i| i.at[0]).collect()
    };
    assert_eq!(along("remove B2"), [0.0, 6.0, 12.0, 18.0]);
    assert_eq!(along("scale B2=2,1,1"), [0.0, 6.0, 15.0, 24.0, 30.0]);
    assert_eq!(along("move R1=0,3,0"), along("move R1=0,0,0"));
    let text = grammar_json::to_string(&street).unwrap();
    assert!(text.contains("\"row\":true") && text.contains("\"version\": 3"));
    let again = grammar_json::parse(text.as_bytes(), Path::new("street.city-grammar.json"));
    assert_eq!(again.unwrap(), street);
    let again = compact::from_bytes(&compact::to_bytes(&street).unwrap());
    assert_eq!(again.unwrap(), street);
}

fn single(city: &City, building: usize) -> City {
    City {
        buildings: vec![city.buildings[building].clone()],
        ..City::default()
    }
}
