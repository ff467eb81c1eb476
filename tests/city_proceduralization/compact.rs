//! Grammars in few bytes: what is written comes back, the same bytes again; damaged files are refused.

use edifice::grammar::instance::{InstanceGrammar, InstanceRule, Kept, Placement, Template};
use edifice::io::city::{compact, grammar_json};
use edifice::methods::city_proceduralization::{Budget, Mode, Precision, Settings, proceduralize};
use edifice::rng::{Stream, stream};
use edifice::shape::triangles::TriangleMesh;
use edifice::unwatched;
use edifice_generators_city_proceduralization as synthetic;
use rand::RngExt;

/// Every triangle that a grammar derives to, in world coordinates, with its building.
fn derived(grammar: &InstanceGrammar) -> Vec<(String, [[u64; 3]; 3])> {
    let mut all = Vec::new();
    for building in grammar.derive().unwrap().city(grammar).buildings {
        for t in building.mesh.corners() {
            let t = t.map(|p| p.map(|v| (v + 0.0).to_bits()));
            // The least of its rotations: the same for a triangle with one corner twice.
            let turned = [0, 1, 2].map(|k| [t[k], t[(k + 1) % 3], t[(k + 2) % 3]]);
            let t = turned.into_iter().min().unwrap();
            // Parts without a building are named by their order.
            let id = building.id.split("instance-").next().unwrap();
            all.push((id.to_owned(), t));
        }
    }
    all.sort();
    all
}

/// Writes, reads and writes again.
fn round(grammar: &InstanceGrammar) -> InstanceGrammar {
    let bytes = compact::to_bytes(grammar).unwrap();
    let read = compact::from_bytes(&bytes).unwrap();
    assert_eq!(compact::to_bytes(&read).unwrap(), bytes);
    read
}

fn made(mode: Mode, budget: Budget, precision: Option<Precision>) -> InstanceGrammar {
    let (mut city, _) = synthetic::city(8, 0.03, 2);
    city.origin = [233_000.25, 581_000.5, -0.125];
    city.reference_system = Some("EPSG:2263".to_owned());
    for (i, b) in city.buildings.iter_mut().enumerate().step_by(3) {
        b.attributes.insert("year".into(), (1900 + i).into());
    }
    let settings = Settings {
        mode,
        budget,
        precision,
        ..Settings::default()
    };
    proceduralize(&city, &settings, &unwatched).unwrap().grammar
}

#[test]
fn grammars_come_back_whole() {
    let precisions = [
        None,
        Some(Precision::Millimetre),
        Some(Precision::Centimetre),
        Some(Precision::Decimetre),
    ];
    let best = precisions.map(|p| (Mode::Best, Budget::Level(3), p));
    let others = [
        (Mode::Best, Budget::All, None),
        (Mode::Best, Budget::Templates(1), None),
        // Rules inside rules, parts inside parts.
        (Mode::Paper, Budget::Level(2), None),
    ];
    for (mode, budget, precision) in best.into_iter().chain(others) {
        let grammar = made(mode, budget, precision);
        let read = round(&grammar);
        assert_eq!(
            derived(&read),
            derived(&grammar),
            "{mode:?} {budget:?} {precision:?}"
        );
        let rest = |g: &InstanceGrammar| {
            let rules = g
                .rules
                .iter()
                .map(|r| (r.symbol.clone(), r.weight, r.successors.len()));
            let templates = g.templates.iter().map(|t| t.symbol.clone());
            let rules: Vec<_> = rules.collect();
            let templates: Vec<_> = templates.collect();
            (
                rules,
                templates,
                g.origin,
                g.reference_system.clone(),
                g.name.clone(),
                g.axiom.clone(),
            )
        };
        assert_eq!(rest(&read), rest(&grammar));
        let attributes = |g: &InstanceGrammar| {
            let mut buildings = g.derive().unwrap().buildings;
            buildings.sort_by(|a, b| a.0.cmp(&b.0));
            buildings
        };
        assert_eq!(attributes(&read), attributes(&grammar));
        // Without identifiers the same triangles.
        let bare = grammar.keeping(Kept::Shape);
        let only = |g: &InstanceGrammar| {
            let mut all: Vec<_> = derived(g).into_iter().map(|t| t.1).collect();
            all.sort();
            all
        };
        assert_eq!(only(&round(&bare)), only(&grammar));
    }
}

#[test]
fn few_bytes_are_fewer_than_packed_text() {
    let grammar = made(Mode::Best, Budget::Level(3), None);
    let (few, text) = (
        compact::to_bytes(&grammar).unwrap().len(),
        grammar_json::packed_bytes(&grammar).unwrap(),
    );
    assert!(2 * few < text, "{few} {text}");
}

/// A grammar of no sense but sound: nested rules, several rules for a symbol, meshes of any triangles, with `fine` numbers off all steps.
fn any(rng: &mut Stream, fine: bool) -> InstanceGrammar {
    let number = |rng: &mut Stream| match fine {
        true => rng.random_range(-1e4..1e4),
        false => f64::from(rng.random_range(-400..400)) / 10.0,
    };
    let mut templates = Vec::new();
    for i in 0..rng.random_range(1..5) {
        let corners = rng.random_range(3..9);
        let side = |rng: &mut Stream| match fine {
            true => rng.random_range(-0.7..1.2),
            false => f64::from(rng.random_range(0..128)) / 127.0,
        };
        let positions = (0..corners).map(|_| [side(rng) - 0.5, side(rng) - 0.5, side(rng)]);
        let positions: Vec<_> = positions.collect();
        // Edges of many triangles, the same triangle twice, triangles of one corner.
        let count = rng.random_range(0..16);
        let triangle = |rng: &mut Stream| [0; 3].map(|_| rng.random_range(0..corners as u32));
        let triangles = (0..count).map(|_| triangle(rng)).collect();
        let symbol = if rng.random_bool(0.7) {
            format!("T{i}")
        } else {
            format!("wall\n{i:03}")
        };
        templates.push(Template {
            symbol,
            mesh: TriangleMesh {
                positions,
                triangles,
            },
            texture: None,
        });
    }
    let names: Vec<String> = (0..rng.random_range(1..5))
        .map(|i| format!("B{}", 7 * i))
        .collect();
    let mut rules: Vec<InstanceRule> = Vec::new();
    // Later names use earlier ones.
    for (i, name) in names.iter().enumerate() {
        for _ in 0..rng.random_range(1..3) {
            let mut successors = Vec::new();
            for _ in 0..rng.random_range(0..6) {
                successors.push(placed(rng, &templates, &names[..i], &rules, &number));
            }
            let weight = if rng.random_bool(0.5) {
                rng.random_range(0.0..9.0)
            } else {
                3.0
            };
            let mut rule = InstanceRule::new(name.clone(), weight, successors);
            if i + 1 < names.len() {
                parametrize(rng, &mut rule, &templates);
            }
            rules.push(rule);
        }
    }
    let mut grammar = InstanceGrammar {
        name: "any \"name\"".to_owned(),
        reference_system: None,
        origin: [1e6 + 0.1, -3.0, 0.0],
        axiom: names[names.len() - 1].clone(),
        templates,
        rules,
    };
    let axiom = grammar.axiom.clone();
    let last = grammar
        .rules
        .iter_mut()
        .filter(|r| r.symbol == axiom)
        .flat_map(|r| &mut r.successors);
    for (i, p) in last.enumerate() {
        p.id = (i % 3 > 0).then(|| format!("b{}", i / 2));
        if i % 2 == 0 {
            p.attributes.insert("n".into(), i.into());
        }
    }
    grammar
}

/// Makes a rule over templates, now and then, one with parameters, or with factors, or a row.
fn parametrize(rng: &mut Stream, rule: &mut InstanceRule, templates: &[Template]) {
    let terminal = |p: &Placement| templates.iter().any(|t| t.symbol == p.symbol);
    if !rule.successors.iter().all(terminal) || rng.random_bool(0.5) {
        return;
    }
    rule.levels = rng.random_range(0..4);
    if rng.random_bool(0.3) {
        rule.scale = [1.0, 0.1, 1.5];
    }
    rule.row = rule.levels == 0 && rule.is_unscaled();
    if rule.levels > 0 {
        for s in &mut rule.successors {
            let share = |rng: &mut Stream| f64::from(rng.random_range(1..2000)) / 1024.0;
            s.at = [
                share(rng),
                -share(rng),
                rng.random_range(0..rule.levels) as f64,
            ];
            s.size = [0; 3].map(|_| share(rng));
        }
    }
}

fn placed(
    rng: &mut Stream,
    templates: &[Template],
    names: &[String],
    rules: &[InstanceRule],
    number: &dyn Fn(&mut Stream) -> f64,
) -> Placement {
    let at = [0; 3].map(|_| number(rng));
    // From 0 to 360 degrees, as everything is written.
    let turn = f64::from(rng.random_range(0..3600)) / 10.0;
    if names.is_empty() || rng.random_bool(0.6) {
        let symbol = &templates[rng.random_range(0..templates.len())].symbol;
        let size = [0; 3].map(|_| number(rng).abs().max(0.1));
        return Placement::new(symbol.clone(), at, turn, size);
    }
    let name = &names[rng.random_range(0..names.len())];
    let factor = if rng.random_bool(0.5) { 1.0 } else { 0.75 };
    let mut out = Placement::new(name.clone(), at, turn, [factor; 3]);
    let rule = rules.iter().find(|r| r.symbol == *name).unwrap();
    let lengths = (0..rule.parameters()).map(|_| number(rng).abs().max(0.1));
    out.numbers = lengths.collect();
    if rng.random_bool(0.5) && !rule.successors.is_empty() {
        // Parts are in metres, also where the rule's own successors are in shares.
        let part = |k: usize, rng: &mut Stream| {
            let mut part = rule.part(k, &out.numbers);
            part.at[0] = -part.at[0];
            if templates.iter().any(|t| t.symbol == part.symbol) {
                part.symbol.clone_from(&templates[0].symbol);
            }
            rng.random_bool(0.8).then_some(part)
        };
        out.parts = (0..rule.successors.len()).map(|k| part(k, rng)).collect();
    }
    out
}

#[test]
fn any_grammar_comes_back() {
    for case in 0..4000 {
        let mut rng = stream(11, "any grammar", case);
        let fine = rng.random_bool(0.5);
        let grammar = any(&mut rng, fine);
        grammar.check().unwrap_or_else(|e| panic!("{case}: {e}"));
        let once = round(&grammar);
        // What lies on no steps is rounded once, and then stays.
        assert_eq!(derived(&round(&once)), derived(&once), "{case}");
        let (a, b) = (derived(&once), derived(&grammar));
        assert_eq!(a.len(), b.len(), "{case}");
        if !fine {
            assert_eq!(a, b, "{case}");
        }
    }
}

/// Bytes whose checksum is right again.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let mut crc = flate2::Crc::new();
    crc.update(&bytes[10..]);
    bytes[6..10].copy_from_slice(&crc.sum().to_le_bytes());
    bytes
}

#[test]
fn damaged_files_are_refused() {
    let bytes = compact::to_bytes(&made(Mode::Best, Budget::Level(4), None)).unwrap();
    for cut in (0..bytes.len()).step_by(97) {
        assert!(compact::from_bytes(&bytes[..cut]).is_err(), "{cut}");
        if cut > 10 {
            let error = compact::from_bytes(&sealed(bytes[..cut].to_vec()));
            assert!(error.is_err(), "{cut}");
        }
    }
    let message = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut changed = bytes.clone();
        change(&mut changed);
        compact::from_bytes(&changed).unwrap_err().to_string()
    };
    assert!(message(&|b| b[0] = b'x').contains("EdCG"));
    assert!(message(&|b| b[4] = 9).contains("version 9"));
    assert!(message(&|b| b[40] ^= 1).contains("checksum"));
    assert!(message(&|b| b.push(0)).contains("checksum"));
    // Whatever the numbers say: an answer or an error, no panic and no flood of memory.
    for case in 0..1000 {
        let mut rng = stream(5, "damaged", case);
        let mut changed = bytes.clone();
        for _ in 0..rng.random_range(1..5) {
            let at = rng.random_range(14..changed.len());
            changed[at] = rng.random();
        }
        let _ = compact::from_bytes(&sealed(changed));
    }
}
