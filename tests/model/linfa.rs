//! Our mixtures behind linfa's traits: as generic linfa code uses them, and beside linfa's own.

use edifice::model::gmm::linfa::{Components, LinfaError, Parameters};
use edifice::model::gmm::{Criterion, Mixture, Points, Settings, fit};
use edifice::model::{ModelError, gmm};
use edifice::rng::stream;
use linfa::DatasetBase;
use linfa::traits::{Fit, Predict};
use linfa_clustering::GaussianMixtureModel;
use ndarray::{Array1, Array2};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

/// Three clusters of 60 points of two coordinates; rows in the order of the clusters.
fn points<R: Rng>(rng: &mut R) -> Array2<f64> {
    let centres = [[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]];
    Array2::from_shape_fn((180, 2), |(i, j)| {
        centres[i / 60][j] + rng.sample::<f64, _>(StandardNormal)
    })
}

/// Generic over linfa: fits and predicts.
fn clusters<P, M>(parameters: &P, data: &Array2<f64>) -> Array1<usize>
where
    P: Fit<Array2<f64>, Array1<()>, LinfaError, Object = M>,
    M: for<'a> Predict<&'a Array2<f64>, Array1<usize>>,
{
    let dataset = DatasetBase::from(data.clone());
    parameters.fit(&dataset).expect("a mixture").predict(data)
}

/// True if two labelings are the same up to names.
fn same(a: &Array1<usize>, b: &Array1<usize>) -> bool {
    let n = a.len();
    (0..n).all(|i| (0..n).all(|j| (a[i] == a[j]) == (b[i] == b[j])))
}

#[test]
fn clusters_as_linfa_does() {
    let data = points(&mut stream(1, "linfa", 0));
    let truth = Array1::from_iter((0..180).map(|i| i / 60));
    assert!(same(&clusters(&Parameters::new(3), &data), &truth));
    let selected = Parameters {
        components: Components::AtMost(6, Criterion::Mdl),
        ..Parameters::new(1)
    };
    assert!(same(&clusters(&selected, &data), &truth));
    let theirs = GaussianMixtureModel::params(3)
        .n_runs(20)
        .fit(&DatasetBase::from(data.clone()))
        .expect("linfa's mixture");
    assert!(same(&theirs.predict(&data), &truth));
}

#[test]
fn the_trait_is_the_function() {
    let data = points(&mut stream(2, "linfa", 0));
    let by_trait = Parameters::new(3)
        .fit(&DatasetBase::from(data.clone()))
        .expect("a mixture");
    let values: Vec<f64> = data.iter().copied().collect();
    let points = Points::new(2, &values).expect("points");
    let fitted = fit(&points, 3, &Settings::default(), &mut stream(0, "gmm", 3));
    let by_function = fitted.expect("a mixture").mixture;
    assert_eq!(by_trait, by_function);
    let posterior = by_function.posterior(&points).expect("same dimension");
    let most = |p: &Vec<f64>| {
        (0..3)
            .max_by(|&a, &b| p[a].total_cmp(&p[b]))
            .expect("three")
    };
    assert!(
        by_trait
            .predict(&data)
            .iter()
            .copied()
            .eq(posterior.iter().map(most))
    );
}

#[test]
fn weights_count_rows() {
    let data = points(&mut stream(3, "linfa", 0));
    // A third of the rows has weight 2, as if it stood twice.
    let weights = Array1::from_iter((0..180).map(|i| if i < 60 { 2.0 } else { 1.0 }));
    let weighted = DatasetBase::from(data.clone()).with_weights(weights);
    let mixture: Mixture = Parameters::new(1).fit(&weighted).expect("a mixture");
    let mean = |j: usize| {
        let sum: f64 = (0..180)
            .map(|i| data[[i, j]] * if i < 60 { 2.0 } else { 1.0 })
            .sum();
        sum / 240.0
    };
    for (j, found) in mixture.mean(0).iter().enumerate() {
        assert!((found - mean(j)).abs() < 1e-6, "{found} {}", mean(j));
    }
}

#[test]
fn errors_are_those_of_the_model_layer() {
    let empty = DatasetBase::from(Array2::<f64>::zeros((0, 2)));
    let few = DatasetBase::from(Array2::<f64>::zeros((2, 2)));
    let unknown = DatasetBase::from(Array2::from_elem((9, 2), f64::NAN));
    let parameters: gmm::linfa::Parameters = Parameters::new(3);
    let refused = |dataset| match parameters.fit(dataset) {
        Err(LinfaError::Model(error)) => error,
        other => panic!("{other:?}"),
    };
    assert!(matches!(refused(&empty), ModelError::Empty { .. }));
    assert!(matches!(refused(&few), ModelError::TooFewRows { .. }));
    assert!(matches!(
        refused(&unknown),
        ModelError::NotFinite { row: 0, .. }
    ));
}
