//! What a format has, and what becomes of it here: for guesses at misspelt names, for what is said, and for
//! `docs/import.md`.

/// What becomes of a thing.
#[derive(Clone, Copy, Debug)]
pub enum Support {
    /// What the format's own renderer shows.
    Done,
    /// Nearly what it shows: how it differs.
    Near(&'static str),
    /// It is said that it is not done, and this.
    Reported(&'static str),
}

/// Names of one kind.
pub type Known = [(&'static str, Support)];

/// The names of a list.
pub fn names(list: &'static Known) -> impl Iterator<Item = &'static str> {
    list.iter().map(|(name, _)| *name)
}

/// What becomes of a name, if it is known.
pub fn of(list: &'static Known, name: &str) -> Option<Support> {
    list.iter().find(|(known, _)| *known == name).map(|&(_, support)| support)
}

/// What happens instead of a thing that is not done.
pub fn consequence(list: &'static Known, name: &str) -> Option<&'static str> {
    match of(list, name) {
        Some(Support::Reported(consequence)) => Some(consequence),
        _ => None,
    }
}

/// What becomes of lists of names, as a table in Markdown: what they are of, and the list.
pub fn table(lists: impl IntoIterator<Item = (String, &'static Known)>) -> String {
    let mut lines =
        vec!["| what | name | here | how it differs |".to_owned(), "| --- | --- | --- | --- |".to_owned()];
    for (what, list) in lists {
        let done: Vec<String> = list
            .iter()
            .filter(|(_, support)| matches!(support, Support::Done))
            .map(|(name, _)| format!("`{name}`"))
            .collect();
        if !done.is_empty() {
            lines.push(format!("| {what} | {} | done | |", done.join(", ")));
        }
        for (name, support) in list {
            match support {
                Support::Done => {}
                Support::Near(how) => lines.push(format!("| {what} | `{name}` | approximated | {how} |")),
                Support::Reported(how) => lines.push(format!("| {what} | `{name}` | reported | {how} |")),
            }
        }
    }
    lines.join("\n")
}
