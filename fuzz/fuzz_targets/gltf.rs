//! Binary files say so in their first bytes; all others are JSON.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let name = if bytes.starts_with(b"glTF") { "scene.glb" } else { "scene.gltf" };
    sr_fuzz::load(name, bytes, &[]);
});
