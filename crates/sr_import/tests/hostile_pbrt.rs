//! pbrt files that mean harm, or were cut: an answer, never a panic, in a time that grows with their length.

use std::path::Path;
use std::time::Instant;

use sr_import::{LoadOptions, load_str};
use sr_scene::Diagnostics;

fn load(text: &str) -> Diagnostics {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/pbrt");
    let (scene, diagnostics) = load_str("hostile.pbrt", text, &folder, &LoadOptions::default());
    assert_eq!(scene.is_none(), diagnostics.has_errors());
    // Rendering has its own indexing into the text.
    diagnostics.render(true);
    diagnostics
}

const VALID: &str = r#"Film "rgb" "integer xresolution" 32 "float cropwindow" [ 0 1 0 0.5 ] # comment
LookAt 0 0 -5 0 0 0 0 1 0 Camera "perspective" "float fov" [ 40 ] Sampler "stratified" "integer xsamples" 2
Integrator "path" "integer maxdepth" 3 PixelFilter "mitchell" ColorSpace "rec2020"
WorldBegin Attribute "shape" "float radius" 0.5 AttributeBegin Rotate 30 1 0 0
MakeNamedMaterial "a" "string type" "coateddiffuse" "spectrum reflectance" [ 400 0.1 700 0.5 ]
Texture "t" "spectrum" "checkerboard" "rgb tex1" [ 1 0 0 ] "float uscale" 4
Texture "b" "float" "bilerp" Material "conductor" "spectrum eta" "metal-Ag-eta" "float roughness" 0.1
NamedMaterial "a" Shape "sphere" "bool x" true Material "diffuse" "texture reflectance" "t"
AreaLightSource "diffuse" "blackbody L" 3000 "bool twosided" "true" "float power" 10
Shape "trianglemesh" "integer indices" [ 0 1 2 2 3 0 ] "point3 P" [ 0 0 0 1 0 0 1 1 0 0 1 0 ] "texture alpha" "b"
Shape "bilinearmesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 1 ] Shape "disk" "float height" 1 AttributeEnd
ObjectBegin "o" Shape "loopsubdiv" "integer levels" 1 "integer indices" [ 0 1 2 ] "point3 P" [ 0 0 0 1 0 0 0 1 0 ]
ObjectEnd Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 2 0 0 1 ] ObjectInstance "o" Include "sphere.pbrt"
LightSource "spot" "float coneangle" 30 "rgb I" [ 1 1 1 ] LightSource "infinite" "rgb L" [ 1 1 1 ]
"#;

#[test]
fn every_cut_has_an_answer() {
    assert!(!load(VALID).has_errors(), "{}", load(VALID).render(false));
    for cut in 0..VALID.len() {
        load(&VALID[..cut]);
    }
}

#[test]
fn changed_characters_never_panic() {
    // A fixed linear congruential generator: the same mutations in every run.
    let mut state = 12345u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize
    };
    let replacements = [
        "\"",
        "[",
        "]",
        "-",
        "#",
        " 9999999999 ",
        " nan ",
        " 1e38 ",
        "",
        "é",
        " 0 ",
        " ",
        "\\",
        " -1 ",
        "AttributeEnd",
        "\n",
    ];
    for _ in 0..3000 {
        let mut changed = VALID.to_owned();
        for _ in 0..1 + next() % 3 {
            let at = next() % changed.len();
            if changed.is_char_boundary(at) && changed.is_char_boundary(at + 1) {
                changed.replace_range(at..at + 1, replacements[next() % replacements.len()]);
            }
        }
        load(&changed);
    }
}

#[test]
fn numbers_that_cannot_be_are_refused() {
    for text in [
        "Film \"rgb\" \"integer xresolution\" 2000000000",
        "Film \"rgb\" \"integer xresolution\" -5",
        "Sampler \"stratified\" \"integer xsamples\" 2000000000 \"integer ysamples\" -1",
        "Camera \"perspective\" \"float fov\" 180",
        "Scale 0 0 0 Camera \"perspective\"",
        "WorldBegin Scale 1e30 1e30 1e30 Scale 1e30 1e30 1e30 Shape \"sphere\"",
        "WorldBegin Shape \"sphere\" \"float radius\" 0",
        "WorldBegin Shape \"trianglemesh\" \"integer indices\" [ 0 1 -7 ] \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]",
        "WorldBegin Shape \"loopsubdiv\" \"integer levels\" 99 \"integer indices\" [ 0 1 2 ] \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]",
        "WorldBegin LightSource \"distant\" \"point3 from\" [ 0 0 1 ]",
        "WorldBegin LightSource \"spot\" \"float coneangle\" -1",
        "WorldBegin LightSource \"infinite\" \"blackbody L\" 0",
        "WorldBegin Shape \"plymesh\" \"string filename\" \"/dev/zero\"",
        "WorldBegin Include \"/dev/zero\"",
        "WorldBegin Rotate 5 0 0 0",
        "Translate 1 2 inf",
    ] {
        assert!(load(text).has_errors(), "{text}");
    }
}

#[test]
fn much_of_the_same_takes_time_in_proportion() {
    let start = Instant::now();
    let many = |part: &str, count: usize| part.repeat(count);
    for text in [
        many("AttributeBegin ", 100_000),
        many("AttributeEnd ", 100_000),
        many("Attribute \"shape\" \"float radius\" 1 ", 100_000),
        format!("WorldBegin {}", many("ObjectBegin \"a\" ObjectEnd ", 20_000)),
        format!("WorldBegin {}", many("Shape \"nothing\" \"float a\" 1 ", 50_000)),
        format!(
            "WorldBegin AreaLightSource \"diffuse\" {} {}",
            many("\"float a\" 1 ", 20_000),
            many("Shape \"sphere\" ", 20_000)
        ),
        (0..20_000).map(|i| format!("NamedMaterial \"m{i}\" ")).collect(),
        (0..20_000)
            .map(|i| format!("Texture \"t{i}\" \"spectrum\" \"imagemap\" \"string filename\" \"f{i}.png\" "))
            .collect(),
        format!("WorldBegin Shape \"sphere\" {}", many("\"float a\" 1 ", 50_000)),
        format!("\"{}", many("x", 1_000_000)),
    ] {
        load(&text);
    }
    // A quadratic step in any of them takes minutes.
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
}

#[test]
fn bombs_are_not_unpacked() {
    use std::io::Write;
    let folder = std::env::temp_dir().join(format!("sr_import-bomb-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("bomb.pbrt.gz");
    let mut gz =
        flate2::write::GzEncoder::new(std::fs::File::create(&path).unwrap(), flate2::Compression::best());
    for _ in 0..300 {
        gz.write_all(&[b' '; 1 << 20]).unwrap();
    }
    gz.finish().unwrap();
    let (scene, diagnostics) = sr_import::load(&path, &LoadOptions::default());
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(scene.is_none());
    assert!(
        diagnostics.list[0].message.contains("unpacked it has more than"),
        "{}",
        diagnostics.list[0].message
    );
}
