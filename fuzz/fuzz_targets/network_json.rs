//! Bayesian networks as JSON: no panic, and what is read is written and read back the same.
#![no_main]

use edifice::model::network::Network;

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Ok(network) = Network::from_json(text) {
        let written = network.to_json().expect("a network can be written");
        assert_eq!(Network::from_json(&written).expect("written by us"), network);
        let _ = network.to_bif();
    }
});
