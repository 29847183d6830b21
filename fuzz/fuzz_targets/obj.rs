//! What follows the first zero byte, if there is one, are the materials `a.mtl`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut parts = bytes.splitn(2, |&byte| byte == 0);
    let (mesh, materials) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
    sr_fuzz::load("mesh.obj", mesh, &[("a.mtl", materials)]);
});
