//! City grammars in few bytes, whose checksum is made right: no panic; written and read back the same.
#![no_main]

use edifice::io::city::compact;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut bytes = bytes.to_vec();
    if let Some((head, rest)) = bytes.split_at_mut_checked(10) {
        let mut crc = flate2::Crc::new();
        crc.update(rest);
        head[6..].copy_from_slice(&crc.sum().to_le_bytes());
    }
    if let Ok(grammar) = compact::from_bytes(&bytes) {
        let written = compact::to_bytes(&grammar).expect("a sound grammar");
        let again = compact::from_bytes(&written).expect("what was written");
        assert_eq!(compact::to_bytes(&again).expect("a sound grammar"), written);
    }
});
