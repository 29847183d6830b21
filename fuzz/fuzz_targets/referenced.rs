//! Files that scenes name, of the formats that are read here and not by a library: the first byte says which.
#![no_main]

const SCENES: [(&str, &str); 5] = [
    ("it.serialized", r#"<shape type="serialized"><string name="filename" value="it.serialized"/></shape>"#),
    ("it.ies", r#"<emitter type="ies"><string name="filename" value="it.ies"/></emitter>"#),
    ("it.pfm", r#"<emitter type="envmap"><string name="filename" value="it.pfm"/></emitter>"#),
    (
        "it.spd",
        r#"<shape type="sphere"><emitter type="area"><spectrum name="radiance" filename="it.spd"/></emitter></shape>"#,
    ),
    ("it.txt", r#"<shape type="bsplinecurve"><string name="filename" value="it.txt"/></shape>"#),
];

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Some((which, bytes)) = bytes.split_first() else { return };
    let (name, used) = SCENES[*which as usize % SCENES.len()];
    let scene = format!(r#"<scene version="3.0.0"><sensor type="perspective"/>{used}</scene>"#);
    sr_fuzz::load("scene.xml", scene.as_bytes(), &[(name, bytes)]);
});
