#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sr_fuzz::load("mesh.stl", bytes, &[]));
