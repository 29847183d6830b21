//! Files that mean harm, or were cut: an answer, never a panic.

use std::path::Path;

use sr_import::{LoadOptions, load_str};

fn load(text: &str) -> sr_scene::Diagnostics {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let (scene, diagnostics) = load_str("hostile.xml", text, &folder, &LoadOptions::default());
    assert_eq!(scene.is_none(), diagnostics.has_errors());
    // Rendering has its own indexing into the text.
    diagnostics.render(true);
    diagnostics
}

fn valid() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/every_kind.xml");
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn every_truncation_is_one_error() {
    let text = valid();
    let end = text.trim_end().len();
    for cut in (1..end).filter(|&at| text.is_char_boundary(at)) {
        let diagnostics = load(&text[..cut]);
        assert!(diagnostics.has_errors(), "cut at {cut}");
        assert_eq!(diagnostics.list.len(), 1, "cut at {cut}:\n{}", diagnostics.render(false));
    }
}

#[test]
fn changed_characters_never_panic() {
    let text = valid();
    // A fixed linear congruential generator: the same mutations in every run.
    let mut state = 12345u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize
    };
    let replacements =
        ["\"", "<", ">", "/", "-", "$", "9999999999", "nan", "", "é", "0", " ", "&", "type", "ref"];
    for _ in 0..4000 {
        let mut changed = text.clone();
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
fn deep_nesting_and_entities_are_refused() {
    let deep = |n: usize| {
        format!(
            "<scene version=\"3.0.0\">{}{}</scene>",
            "<bsdf type=\"twosided\">".repeat(n),
            "</bsdf>".repeat(n)
        )
    };
    assert!(load(&deep(100)).list.iter().any(|d| d.code == "mitsuba::too-deep"));
    assert!(load(&deep(200_000)).has_errors());
    let bomb =
        "<!DOCTYPE a [<!ENTITY b \"bbbb\"><!ENTITY c \"&b;&b;\">]><scene version=\"3.0.0\">&c;</scene>";
    assert_eq!(load(bomb).list[0].code, "xml::dtd");
}

#[test]
fn files_that_include_themselves_end() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let (scene, diagnostics) = sr_import::load(&folder.join("ouroboros.xml"), &LoadOptions::default());
    assert!(scene.is_none());
    assert!(diagnostics.list.iter().any(|d| d.message.contains("includes itself")));
}

#[test]
fn parameters_that_double_are_refused() {
    let defaults: String =
        (1..60).map(|i| format!("<default name=\"a{i}\" value=\"$a{0}-1$a{0}-1\"/>\n", i - 1)).collect();
    let text =
        format!("<scene version=\"3.0.0\">\n<default name=\"a0\" value=\"xxxxxxxxxx\"/>\n{defaults}</scene>");
    let diagnostics = load(&text);
    let long: Vec<_> = diagnostics.list.iter().filter(|d| d.code == "mitsuba::parameter-too-long").collect();
    assert!(!long.is_empty());
    let line = diagnostics.one_line(long[0]);
    assert!(line.starts_with("hostile.xml:15:"), "{line}");
    assert!(line.contains("shorter values"), "{line}");
}

#[test]
fn aliases_do_not_copy() {
    // Copies would be 20,000 × 20,000 properties: more than 40 GB.
    let properties: String = (0..20_000).map(|i| format!("<float name=\"b{i}\" value=\"1\"/>")).collect();
    let aliases: String = (0..20_000).map(|i| format!("<alias id=\"a\" as=\"c{i}\"/>")).collect();
    let diagnostics = load(&format!(
        "<scene version=\"3.0.0\"><bsdf type=\"diffuse\" id=\"a\">{properties}</bsdf>{aliases}\
         <shape type=\"sphere\"><ref id=\"c19999\"/></shape></scene>"
    ));
    assert!(!diagnostics.has_errors());
}

#[test]
fn aliases_are_other_names() {
    let scene = |aliases: &str, id: &str| {
        load(&format!(
            "<scene version=\"3.0.0\"><sensor type=\"perspective\" id=\"s\"><float name=\"fov\" value=\"40\"/></sensor><bsdf type=\"diffuse\" id=\"a\"/>\
             <bsdf type=\"conductor\" id=\"b\"/>{aliases}<shape type=\"sphere\"><ref id=\"{id}\"/></shape></scene>"
        ))
    };
    let codes = |d: &sr_scene::Diagnostics| d.list.iter().map(|d| d.code).collect::<Vec<_>>();
    let chain = "<alias id=\"a\" as=\"c\"/><alias id=\"c\" as=\"d\"/>";
    assert!(!scene(chain, "d").has_errors());
    assert_eq!(codes(&scene(chain, "e")), ["mitsuba::unresolved-reference"]);
    assert_eq!(codes(&scene("<alias id=\"x\" as=\"c\"/>", "a")), ["mitsuba::unresolved-reference"]);
    assert_eq!(codes(&scene("<alias id=\"s\" as=\"c\"/>", "a")), ["mitsuba::bad-alias"]);
    let taken = codes(&scene("<alias id=\"a\" as=\"b\"/>", "a"));
    assert!(taken.contains(&"mitsuba::duplicate-id"), "{taken:?}");
}

#[test]
fn properties_given_twice_are_reported_and_the_later_is_used() {
    let twice = |property: &str, again: &str| {
        load(&format!(
            "<scene version=\"3.0.0\"><shape type=\"sphere\">{property}<bsdf type=\"diffuse\"/>{again}</shape></scene>"
        ))
    };
    let codes = |d: sr_scene::Diagnostics| d.list.iter().map(|d| d.code).collect::<Vec<_>>();
    let once = codes(twice("<float name=\"radius\" value=\"2\"/>", ""));
    let radius = twice("<float name=\"radius\" value=\"-\"/>", "<float name=\"Radius\" value=\"2\"/>");
    assert!(radius.has_errors(), "a bad value is an error even if another follows");
    let mut expected = vec!["mitsuba::duplicate-property"];
    expected.extend(once);
    let (old, new) = ("<transform name=\"toWorld\"/>", "<transform name=\"to_world\"/>");
    assert_eq!(codes(twice(old, new)), expected);
    assert_eq!(
        codes(twice("<string name=\"radius\" value=\"a\"/>", "<float name=\"radius\" value=\"2\"/>")),
        expected
    );
}
