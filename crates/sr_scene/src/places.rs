//! Offsets into a text to lines and columns, without reading the text from its start each time.
//!
//! The place of every 1024th byte is kept. A table of lines would not do: a text can be one long line.

/// The distance of the places that are kept, in bytes.
const STEP: usize = 1024;

/// The places of every [`STEP`]th byte of a text.
#[derive(Clone, Debug)]
pub struct Places(Vec<Place>);

/// One-based line and column.
#[derive(Clone, Copy, Debug)]
struct Place {
    line: usize,
    column: usize,
}

impl Place {
    /// Goes over bytes of UTF-8.
    fn after(self, bytes: &[u8]) -> Self {
        bytes.iter().fold(self, |Place { line, column }, byte| match byte {
            b'\n' => Place { line: line + 1, column: 1 },
            // The second and later bytes of a character.
            0x80..=0xbf => Place { line, column },
            _ => Place { line, column: column + 1 },
        })
    }
}

impl Places {
    /// Goes over a text once.
    pub fn new(text: &str) -> Self {
        let places = text.as_bytes().chunks(STEP).scan(Place { line: 1, column: 1 }, |place, chunk| {
            let start = *place;
            *place = start.after(chunk);
            Some(start)
        });
        Self(places.collect())
    }

    /// One-based line and column of the character that byte `at` of the same text is in; its end, if it is behind.
    pub fn line_column(&self, text: &str, at: usize) -> (usize, usize) {
        let at = (0..=at.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0);
        let index = (at / STEP).min(self.0.len().saturating_sub(1));
        let Some(place) = self.0.get(index) else { return (1, 1) };
        let Place { line, column } = place.after(&text.as_bytes()[index * STEP..at]);
        (line, column)
    }
}

#[cfg(test)]
mod tests {
    use super::{Places, STEP};

    /// By the definition, from the start of the text.
    fn counted(text: &str, at: usize) -> (usize, usize) {
        let before: String =
            text.char_indices().take_while(|(i, c)| i + c.len_utf8() <= at).map(|(_, c)| c).collect();
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        (before.matches('\n').count() + 1, column)
    }

    #[test]
    fn places_are_those_counted_from_the_start() {
        for unit in ["a", "é", "\n", "ab\n", "日本\r\n", "𝄞 and more on a line\n"] {
            for length in [0, 1, STEP - 1, STEP, STEP + 1, 2 * STEP] {
                let text = unit.repeat(length.div_ceil(unit.len()));
                let places = Places::new(&text);
                for at in (0..text.len() + 3).step_by(7).chain([STEP - 1, STEP, STEP + 1, text.len()]) {
                    assert_eq!(
                        places.line_column(&text, at),
                        counted(&text, at),
                        "{unit:?}, {length}, byte {at}"
                    );
                }
            }
        }
    }
}
