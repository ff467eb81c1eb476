//! Bayesian networks: no panic, and what is read is written and read back the same.
#![no_main]

use edifice::model::network::Network;

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Ok(network) = Network::from_bif(text)
        && let Ok(written) = network.to_bif()
    {
        assert_eq!(Network::from_bif(&written).expect("written by us"), network);
    }
});
