//! Bayesian networks in XMLBIF: no panic, and what is read is written and read back the same.
#![no_main]

use edifice::model::network::Network;

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Ok(network) = Network::from_xmlbif(text) {
        let written = network.to_xmlbif().expect("tables only");
        let again = Network::from_xmlbif(&written).expect("written by us");
        assert_eq!(again.names().collect::<Vec<_>>(), network.names().collect::<Vec<_>>());
    }
});
