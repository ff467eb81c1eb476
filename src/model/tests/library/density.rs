//! Log densities: total mass, unit changes, recovery, bad input.

use edifice_base::rng::stream;
use edifice_model::density::{
    Conditional, KernelDensity, LogDensity, ScalarMixture, SmoothHistogram,
};
use edifice_model::gmm;
use rand::RngExt;
use rand_distr::{Distribution, Normal};

/// Two lumps: 70 % at 1 ± 0.1, 30 % at 3 ± 0.4.
fn lumps(count: usize) -> Vec<f64> {
    let mut rng = stream(5, "lumps", 0);
    let (narrow, wide) = (
        Normal::new(1.0, 0.1).unwrap(),
        Normal::new(3.0, 0.4).unwrap(),
    );
    (0..count)
        .map(|_| match rng.random::<f64>() < 0.7 {
            true => narrow.sample(&mut rng),
            false => wide.sample(&mut rng),
        })
        .collect()
}

fn mass(density: &impl LogDensity, low: f64, high: f64) -> f64 {
    let steps = 20_000;
    let width = (high - low) / f64::from(steps);
    let at = |i| {
        density
            .log_density(&[low + (f64::from(i) + 0.5) * width])
            .exp()
    };
    (0..steps).map(at).sum::<f64>() * width
}

fn histogram(values: &[f64], unit: f64) -> SmoothHistogram {
    SmoothHistogram::fit(vec![0.0], vec![5.0 * unit], vec![50], 1.5, values).unwrap()
}

#[test]
fn each_density_has_mass_one_and_a_maximum() {
    let values = lumps(500);
    let mixture = ScalarMixture::fit(&values, 1e-3, 1).unwrap();
    let kernel = KernelDensity::fit(1, &values, 1e-3).unwrap();
    let histogram = histogram(&values, 1.0);
    assert_eq!(mixture.components(), 2);
    for (i, (mass, max, peak)) in [
        (
            mass(&mixture, -2.0, 8.0),
            mixture.log_max(),
            mixture.log_density(&[1.0]),
        ),
        (
            mass(&kernel, -2.0, 8.0),
            kernel.log_max(),
            kernel.log_density(&[1.0]),
        ),
        (
            mass(&histogram, 0.0, 5.0),
            histogram.log_max(),
            histogram.log_density(&[1.0]),
        ),
    ]
    .into_iter()
    .enumerate()
    {
        assert!((mass - 1.0).abs() < 1e-3, "density {i}: {mass}");
        assert!(
            max >= peak - 0.01 && max < peak + 0.3,
            "density {i}: {max} {peak}"
        );
    }
    // The true density at the two modes.
    let truth = |w: f64, s: f64| (w / (s * std::f64::consts::TAU.sqrt())).ln();
    assert!((mixture.log_density(&[1.0]) - truth(0.7, 0.1)).abs() < 0.15);
    assert!((mixture.log_density(&[3.0]) - truth(0.3, 0.4)).abs() < 0.25);
}

#[test]
fn units_change_nothing_but_the_unit() {
    let values = lumps(300);
    for unit in [1e-6, 0.01, 1000.0] {
        let scaled: Vec<f64> = values.iter().map(|v| v * unit).collect();
        let pairs: [(Box<dyn LogDensity>, Box<dyn LogDensity>); 3] = [
            (
                Box::new(ScalarMixture::fit(&values, 0.01, 1).unwrap()),
                Box::new(ScalarMixture::fit(&scaled, 0.01 * unit, 1).unwrap()),
            ),
            (
                Box::new(KernelDensity::fit(1, &values, 1e-3).unwrap()),
                Box::new(KernelDensity::fit(1, &scaled, 1e-3 * unit).unwrap()),
            ),
            (
                Box::new(histogram(&values, 1.0)),
                Box::new(histogram(&scaled, unit)),
            ),
        ];
        for (i, (plain, scaled)) in pairs.iter().enumerate() {
            for x in [0.55, 1.013, 2.217, 3.331] {
                let (a, b) = (plain.log_density(&[x]), scaled.log_density(&[x * unit]));
                assert!((a - b - unit.ln()).abs() < 1e-6, "density {i}: {a} {b}");
                let (a, b) = (plain.relative(&[x]), scaled.relative(&[x * unit]));
                assert!((a - b).abs() < 1e-6 && a <= 0.0, "density {i}: {a} {b}");
            }
        }
    }
}

#[test]
fn two_dimensions() {
    let mut rng = stream(6, "plane", 0);
    let rows: Vec<f64> = (0..400).map(|_| rng.random::<f64>()).collect();
    let bins = vec![10, 5];
    let box_ = SmoothHistogram::fit(vec![0.0; 2], vec![1.0; 2], bins, 1.0, &rows).unwrap();
    let kernel = KernelDensity::fit(2, &rows, 1e-3).unwrap();
    let mixture = gmm::fit(
        &gmm::Points::new(2, &rows).unwrap(),
        1,
        &gmm::Settings::default(),
        &mut rng,
    )
    .unwrap()
    .mixture;
    let all: [&dyn LogDensity; 3] = [&box_, &kernel, &mixture];
    for density in all {
        assert_eq!(density.dimension(), 2);
        // Uniform: log density 0 everywhere.
        assert!(density.log_density(&[0.5, 0.5]).abs() < 0.6);
        assert!(density.relative(&[0.5, 0.5]) <= 0.0);
    }
}

#[test]
fn a_density_given_a_value_is_that_of_its_range() {
    // x is near 0 for small g and near 1 for large g.
    let pairs: Vec<(f64, f64)> = (0..200)
        .map(|i| {
            (
                f64::from(i / 10),
                f64::from(u8::from(i >= 100)) + f64::from(i % 10) / 100.0,
            )
        })
        .collect();
    let given = Conditional::fit(&pairs, 4, |values| ScalarMixture::fit(values, 0.01, 1)).unwrap();
    assert!(given.is_whole());
    assert!(given.given(0.0).relative(&[0.05]) > -1.0);
    assert!(given.given(0.0).relative(&[1.05]) < -20.0);
    assert!(given.given(19.0).relative(&[1.05]) > -1.0);
    // Equal values stay together: one range only.
    let equal: Vec<(f64, f64)> = pairs.iter().map(|p| (0.0, p.1)).collect();
    let one = Conditional::fit(&equal, 4, |v| ScalarMixture::fit(v, 0.01, 1)).unwrap();
    assert!(one.given(-1.0).relative(&[1.05]) > -5.0 && one.is_whole());
}

#[test]
fn degenerate_and_bad_values() {
    let point = ScalarMixture::fit(&[2.0; 30], 0.01, 1).unwrap();
    assert!((mass(&point, 1.0, 3.0) - 1.0).abs() < 1e-6);
    assert!(ScalarMixture::fit(&[2.0], 0.0, 1).is_err());
    assert!(ScalarMixture::fit(&[], 0.1, 1).is_err());
    assert!(ScalarMixture::fit(&[f64::NAN], 0.1, 1).is_err());
    assert!(ScalarMixture::new(vec![1.0], vec![0.0], vec![0.0]).is_err());
    assert!(KernelDensity::fit(2, &[1.0; 3], 0.1).is_err());
    assert!(KernelDensity::fit(1, &[1.0; 3], 0.0).is_err());
    assert!(SmoothHistogram::fit(vec![0.0], vec![0.0], vec![5], 1.0, &[0.0]).is_err());
    assert!(SmoothHistogram::fit(vec![0.0], vec![1.0], vec![usize::MAX], 1.0, &[0.0]).is_err());
    let empty: [(f64, f64); 0] = [];
    assert!(Conditional::fit(&empty, 3, |v| ScalarMixture::fit(v, 0.1, 1)).is_err());
    // What a file holds is checked.
    let text = serde_json::to_string(&point).unwrap();
    assert_eq!(serde_json::from_str::<ScalarMixture>(&text).unwrap(), point);
    assert!(serde_json::from_str::<ScalarMixture>(&text.replace("0.01", "-0.01")).is_err());
}
