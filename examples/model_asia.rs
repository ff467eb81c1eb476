//! A Bayesian network from a file: posteriors, explanations, soft evidence, and an answer by sampling with its error.
//! `cargo run --example model_asia --no-default-features`

use edifice::model::network::{Evidence, Network};
use edifice::rng::stream;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/model");
    let asia = Network::from_bif(&std::fs::read_to_string(format!("{folder}/asia.bif"))?)?;

    // A smoker comes with shortness of breath.
    let given = Evidence::new().is("smoke", "yes").is("dysp", "yes");
    for answer in asia.marginals(&given)? {
        println!("{:8} {:.4?}", answer.name, answer.probabilities);
    }
    let best = asia.explain(&given)?;
    println!(
        "most probable, log {:.3}: {:?}",
        best.log_joint, best.values
    );

    // An X-ray that the doctor finds three times as likely with a shadow as without.
    let doubtful = given.likely("xray", &[0.75, 0.25]);
    let cancer = asia.marginal(&doubtful, "lung")?[0];
    println!("lung cancer after a doubtful X-ray: {cancer:.4}");

    // Where a network is too wide for exact answers: draws, with standard errors.
    let estimates = asia.likelihood_weighting(&doubtful, 20_000, &mut stream(2, "example", 0))?;
    let found = estimates.iter().find(|e| e.name == "lung");
    let found = found.ok_or("lung is a variable of ASIA")?;
    println!(
        "by sampling: {:.4} +- {:.4}",
        found.probabilities[0], found.errors[0]
    );
    assert!((found.probabilities[0] - cancer).abs() < 5.0 * found.errors[0]);
    Ok(())
}
