//! The score as the paper means it (Sec. 4): whole grids above grids with a hole, by the model that ships.

use edifice::methods::structure_completion::layout::{Class, Element, Layout};
use edifice::methods::structure_completion::made::grids::{self, Sight};
use edifice::methods::structure_completion::measure::agreement;
use edifice::methods::structure_completion::model::{Model, shipped_model};
use edifice::methods::structure_completion::policy::{PaperModel, complete};
use edifice::methods::structure_completion::score::{ScoreModel, Term, Training};
use edifice::rng::stream;
use edifice::shape::Rect;

use crate::cases::cases;

fn score(model: &ScoreModel, layout: &Layout, elements: &[Element]) -> f64 {
    let facade = [layout.width, layout.height];
    model.score(&model.evaluate(facade, elements).features)
}

fn shipped_score() -> ScoreModel {
    shipped_model().unwrap().paper.unwrap().score
}

#[test]
fn no_weight_speaks_against_what_is_probable() {
    let weights = shipped_score().weights;
    assert!(weights.iter().all(|w| *w >= 0.0), "{weights:?}");
    // The two that tell a hole count.
    for term in [Term::Regularity, Term::Completeness] {
        assert!(weights[term as usize] > 0.1, "{weights:?}");
    }
}

/// On 95 % of made grids at least the whole grid scores above every one that lacks an element; here of 240.
#[test]
fn whole_grids_score_above_those_with_a_hole() {
    let model = shipped_score();
    let made: Vec<Layout> = (1..11).flat_map(grids::all).map(|g| g.0).collect();
    let above = |layout: &&Layout| {
        let whole = score(&model, layout, &layout.elements);
        (0..layout.elements.len()).all(|without| {
            let mut elements = layout.elements.clone();
            elements.remove(without);
            score(&model, layout, &elements) < whole
        })
    };
    let above = made.iter().filter(above).count();
    println!("{above} of {}", made.len());
    assert!(above * 100 >= 95 * made.len(), "{above} of {}", made.len());
}

#[test]
fn the_method_of_the_paper_completes_made_grids() {
    let model = shipped_model().unwrap();
    let made = grids::all(1);
    let perfect = |k: &usize| {
        let (layout, size) = &made[*k];
        let sight = Sight::Scattered;
        let (partial, hidden) = sight.of(layout, *size, &mut stream(1, sight.name(), *k as u64));
        let rng = &mut stream(1, "benchmark: grids", *k as u64);
        let done = complete(&partial, &model, 1, rng);
        let added: Vec<Element> = done[0].added.iter().map(|c| c.element).collect();
        agreement(&added, &hidden, 0.9).f1 == 1.0
    };
    let tried = cases(made.len());
    let some = (0..made.len()).step_by(made.len() / tried);
    let whole = some.filter(perfect).count();
    // Two of the 24 may fail, none of a quarter of them.
    assert!(whole >= tried - tried / 12, "{whole} of {tried}");
}

/// Facades without a door are all symmetric, those with one are not: each is judged by its own kind.
#[test]
fn no_door_is_a_condition_of_its_own() {
    let facade = |index: usize, door: Option<f64>, skew: f64| {
        let mut made = grids::grid(4, 3, (10.0, 16.0), (8.0, 12.0), (6.0, 24.0));
        made.name = index.to_string();
        for element in &mut made.elements {
            element.rect.x += skew;
        }
        let door = door.map(|x| Element::new(Class::Door, Rect::new(x, 0.0, 9.0, 20.0)));
        made.elements.extend(door);
        made
    };
    let database: Vec<Layout> = (0..20)
        .map(|i| match i % 2 {
            0 => facade(i, None, 0.0),
            _ => facade(i, Some(4.0), -5.0),
        })
        .collect();
    let model = ScoreModel::train(&database, &Training::default()).unwrap();
    let symmetry = |layout: &Layout| {
        let facade = [layout.width, layout.height];
        model.evaluate(facade, &layout.elements).features[Term::Symmetry as usize]
    };
    let own = [symmetry(&database[0]), symmetry(&database[1])];
    assert!(own.iter().all(|s| *s == 0.0), "{own:?}");
    let others = [
        symmetry(&facade(0, None, -5.0)),
        symmetry(&facade(0, Some(4.0), 0.0)),
    ];
    assert!(others.iter().all(|s| *s < -0.5), "{others:?}");
}

/// Files of before have no density of facades without a door, no most probable regularity and no grids of coherence sets.
#[test]
fn models_of_before_are_read() {
    let text = shipped_model().unwrap().to_json();
    let mut file: serde_json::Value = serde_json::from_str(&text).unwrap();
    let paper = &mut file["paper"]["score"];
    let remove = |name: &str, object: &mut serde_json::Value| {
        assert!(object.as_object_mut().unwrap().remove(name).is_some());
    };
    remove("regular", paper);
    remove("doorless", paper);
    remove("grids", &mut paper["compatibility"]);
    let old = Model::from_json(&file.to_string()).unwrap();
    let made = &grids::all(1)[0].0;
    assert!(score(&old.paper.unwrap().score, made, &made.elements).is_finite());
    file["paper"]["score"]["compatibility"]["grids"] = serde_json::json!([vec![0; 16]]);
    assert!(Model::from_json(&file.to_string()).is_err());
}

#[test]
fn training_gives_the_same_model_again() {
    let layouts: Vec<Layout> = shipped_model()
        .unwrap()
        .layouts()
        .into_iter()
        .take(2 * cases(2))
        .collect();
    let train = || PaperModel::train(&layouts, 3, &edifice::unwatched).unwrap();
    let learnt = train();
    assert_eq!(learnt, train());
    assert!(learnt.score.weights.iter().all(|w| *w >= 0.0));
}
