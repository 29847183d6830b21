//! What becomes of the plugins, keywords and extensions of the three formats: what the documentation says, and how much of what
//! real scenes use is done.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

fn page() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/import.md");
    std::fs::read_to_string(path).unwrap()
}

/// After a change of the lists, put there what this prints.
#[test]
fn the_documentation_says_what_becomes_of_mitsubas_plugins() {
    let table = sr_import::mitsuba_support_table();
    assert!(table.lines().count() > 60, "no table, no evidence");
    assert!(page().contains(&table), "docs/import.md lacks this:\n{table}");
}

fn scenes() -> Option<PathBuf> {
    let default = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes");
    let folder = std::env::var_os("STERADIAN_SCENES").map_or(default, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    assert!(std::env::var_os("CI").is_none(), "no scenes in {}: set STERADIAN_SCENES", folder.display());
    eprintln!("not run: no scenes in {}", folder.display());
    None
}

fn collect(folder: &Path, extensions: &[&str], files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a readable folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            collect(&path, extensions, files);
        } else if path.extension().is_some_and(|e| extensions.iter().any(|x| e == *x)) {
            files.push(path);
        }
    }
}

/// What a name is, such as "bsdf", and the name.
type Name = (String, String);

/// What becomes of names, by the tables of the documentation.
fn statuses(table: &str) -> BTreeMap<Name, String> {
    let mut statuses = BTreeMap::new();
    for row in table.lines().skip(2) {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let [what, names, status, ..] = cells[..] else { panic!("{row}") };
        let what = what.trim_start_matches("our own ").trim_end_matches(" of 0.6");
        for name in names.split(", ") {
            statuses.insert((what.to_owned(), name.trim_matches('`').to_owned()), status.to_owned());
        }
    }
    statuses
}

/// The elements of Mitsuba's files, of objects their types.
fn mitsubas(file: &Path, names: &mut BTreeSet<Name>) {
    let text = std::fs::read_to_string(file).expect("a readable file");
    let Ok(document) = roxmltree::Document::parse(&text) else { return };
    let steps = ["translate", "rotate", "scale", "matrix", "lookat", "lookAt", "look_at"];
    for element in document.descendants().filter(roxmltree::Node::is_element) {
        let tag = element.tag_name().name();
        if steps.contains(&tag) {
            continue;
        }
        match element.attribute("type") {
            None => names.insert(("element".into(), tag.to_owned())),
            // A parameter's, or one that Mitsuba does not know either: its names are in lower case.
            Some(kind) if !kind.starts_with(|c: char| c.is_ascii_lowercase()) => false,
            Some(kind) => {
                let class = if tag == "spectrum" { "texture" } else { tag };
                names.insert((class.to_owned(), kind.to_owned()))
            }
        };
    }
}

/// pbrt's directives, and the types that they give.
fn pbrts(file: &Path, names: &mut BTreeSet<Name>) {
    let text = String::from_utf8_lossy(&std::fs::read(file).expect("a readable file")).into_owned();
    let words = words(&text);
    for (at, word) in words.iter().enumerate() {
        let is_directive = word.chars().next().is_some_and(|c| c.is_ascii_uppercase());
        // The last three are times of ActiveTransform.
        if !is_directive || ["WorldBegin", "WorldEnd", "All", "StartTime", "EndTime"].contains(&word.as_str())
        {
            continue;
        }
        names.insert(("directive".into(), word.clone()));
        let text =
            |offset: usize| words.get(at + offset).and_then(|w| w.strip_prefix('"')).map(str::to_owned);
        let of_type = |what: &str| {
            let kind =
                (2..).map_while(|i| words.get(at + i)).take_while(|w| !w.starts_with(char::is_uppercase));
            let kind =
                kind.skip_while(|w| *w != "\"string type").find(|w| *w != "\"string type" && *w != "[");
            kind.map(|k| (what.to_owned(), k.trim_start_matches('"').to_owned()))
        };
        let what = match word.as_str() {
            "Shape" => "shape",
            "Material" => "material",
            "LightSource" | "AreaLightSource" => "light",
            "Camera" => "camera",
            "Film" => "film",
            "PixelFilter" => "filter",
            "Integrator" => "integrator",
            "Texture" => {
                names.extend(text(3).map(|kind| ("texture".to_owned(), kind)));
                continue;
            }
            "MakeNamedMaterial" => {
                names.extend(of_type("material"));
                continue;
            }
            _ => continue,
        };
        // The material "" is the interface.
        names.extend(text(1).map(|k| (what.to_owned(), if k.is_empty() { "interface".into() } else { k })));
    }
}

/// Words as they are, texts with the quotation mark before them; without comments and numbers.
fn words(text: &str) -> Vec<String> {
    let mut words = Vec::new();
    for line in text.lines() {
        for (at, part) in line.split('"').enumerate() {
            if at % 2 == 1 {
                words.push(format!("\"{part}"));
                continue;
            }
            let (code, is_comment) = part.split_once('#').map_or((part, false), |(code, _)| (code, true));
            let is_word = |w: &&str| w.starts_with(|c: char| c.is_ascii_alphabetic() || c == '[');
            words.extend(code.split_whitespace().filter(is_word).map(str::to_owned));
            if is_comment {
                break;
            }
        }
    }
    words
}

/// What `extensionsUsed` lists.
fn gltfs(file: &Path, names: &mut BTreeSet<Name>) {
    let bytes = std::fs::read(file).expect("a readable file");
    let text = String::from_utf8_lossy(&bytes);
    let Some((_, list)) = text.split_once("\"extensionsUsed\"") else { return };
    let list = list.split_once('[').and_then(|(_, list)| list.split_once(']')).expect("a list").0;
    let parts = list.split('"').enumerate().filter(|(at, _)| at % 2 == 1);
    names.extend(parts.map(|(_, name)| ("extension".to_owned(), name.to_owned())));
}

/// Media are read and said, and not rendered: whatever else a file asks for of them is said with them.
fn is_of_media((what, name): &Name) -> bool {
    let directives = ["MakeNamedMedium", "MediumInterface"];
    ["medium", "phase", "volume"].contains(&what.as_str()) || directives.contains(&name.as_str())
}

/// The bar: of the distinct names that occur in real scenes, nine of ten are done, if only nearly; media apart.
#[test]
fn nine_of_ten_that_real_scenes_use_are_done() {
    let Some(folder) = scenes() else { return };
    let gltf_table: String = sr_import::gltf_extensions()
        .iter()
        .map(|(name, support)| format!("\n| extension | `{name}` | {} |", support.split(':').next().unwrap()))
        .collect();
    type Count = fn(&Path, &mut BTreeSet<Name>);
    let formats: [(&str, &[&str], Count, String, usize); 3] = [
        ("Mitsuba", &["xml"], mitsubas, sr_import::mitsuba_support_table(), 70),
        ("pbrt-v4", &["pbrt"], pbrts, sr_import::pbrt_support_table(), 40),
        ("glTF 2.0", &["gltf", "glb"], gltfs, format!("\n{gltf_table}"), 10),
    ];
    for (format, extensions, count, table, least) in formats {
        let mut files = Vec::new();
        collect(&folder, extensions, &mut files);
        let mut names = BTreeSet::new();
        files.iter().for_each(|file| count(file, &mut names));
        assert!(names.len() >= least, "{format}: only {} names, no evidence", names.len());
        let statuses = statuses(&table);
        let with = |status: &str| -> Vec<&Name> {
            names
                .iter()
                .filter(|name| statuses.get(name).map_or("unknown", String::as_str) == status)
                .collect()
        };
        let (done, near) = (with("done").len(), with("approximated").len());
        let others: Vec<&Name> = with("reported").into_iter().chain(with("unknown")).collect();
        let all = (done + near) as f64 / names.len() as f64;
        let apart: Vec<_> = names.iter().filter(|name| !is_of_media(name)).collect();
        let not_done = others.iter().filter(|name| !is_of_media(name)).count();
        let fraction = 1.0 - not_done as f64 / apart.len() as f64;
        let others: Vec<String> = others.iter().map(|(what, name)| format!("{what} {name}")).collect();
        eprintln!(
            "{format}: of {} names, {done} are done and {near} nearly: {:.1} %, {:.1} % media apart; not {}",
            names.len(),
            100.0 * all,
            100.0 * fraction,
            others.join(", ")
        );
        assert!(fraction >= 0.9, "{format}: {fraction}");
    }
}
