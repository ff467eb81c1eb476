//! Generic probability: state a network and ask it; learn a mixture, and how many components it has.
//! `cargo run --example model --no-default-features`

use edifice::model::ModelError;
use edifice::model::gmm::{Criterion, Points, Settings, select};
use edifice::model::network::{Evidence, Network, Variable};
use edifice::rng::stream;
use rand::RngExt;
use rand_distr::StandardNormal;

fn main() -> Result<(), ModelError> {
    // Was it rain that made the street wet, and the gauge high?
    let network = Network::new(vec![
        Variable::table("rain", &["no", "yes"], &[], &[0.8, 0.2]),
        Variable::table("wet", &["no", "yes"], &["rain"], &[0.9, 0.1, 0.2, 0.8]),
        Variable::linear("level", 1, &["rain"], &[(&[1.0], &[0.5]), (&[3.0], &[0.5])]),
    ])?;
    let given = Evidence::new().is("wet", "yes").real("level", &[2.5]);
    let rain = network.marginal(&given, "rain")?[1];
    println!("P(rain | wet, level 2.5) = {rain:.3}");
    assert!(rain > 0.9);

    // Window widths of two makes.
    let mut rng = stream(7, "widths", 0);
    let widths: Vec<f64> = (0..60)
        .map(|i| if i % 3 == 0 { 1.4 } else { 0.8 } + 0.05 * rng.sample::<f64, _>(StandardNormal))
        .collect();
    let points = Points::new(1, &widths)?;
    let selected = select(&points, 5, Criterion::Mdl, &Settings::default(), 7)?;
    let mixture = selected.fitted.mixture;
    for k in 0..mixture.components() {
        let (share, mean) = (mixture.weights()[k], mixture.mean(k)[0]);
        println!(
            "{:.0} % of the windows are about {mean:.2} wide",
            100.0 * share
        );
    }
    assert_eq!(mixture.components(), 2);
    let drawn = mixture.sample(3, &mut rng);
    println!("three more: {drawn:.2?}");
    Ok(())
}
