//! Notices, one per kind: a scene of a thousand materials must not print a thousand lines.

use std::collections::BTreeMap;

/// Elements named in one notice.
const NAMED: usize = 3;

/// Kinds of notices, with the first elements and the number of all.
#[derive(Default)]
pub(super) struct Notices(BTreeMap<String, (usize, Vec<String>)>);

impl Notices {
    /// Counts `element` under `kind`.
    pub fn add(&mut self, kind: String, element: String) {
        let (count, named) = self.0.entry(kind).or_default();
        *count += 1;
        if named.len() < NAMED && !named.contains(&element) {
            // Names come from the file: a long one is cut.
            named.push(element.chars().take(60).filter(|c| !c.is_control()).collect());
        }
    }

    /// One line for each kind.
    pub fn into_messages(self) -> Vec<String> {
        let line = |(kind, (count, named)): (String, (usize, Vec<String>))| {
            let more = if count > named.len() { ", …" } else { "" };
            format!("{count} {kind}: {}{more}", named.join(", "))
        };
        self.0.into_iter().map(line).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Notices;

    #[test]
    fn one_line_for_each_kind_with_a_few_names() {
        let mut notices = Notices::default();
        for i in 0..5 {
            notices.add("extensions ignored".into(), format!("EXT_{i}"));
        }
        notices.add("animations ignored".into(), "\u{7}walk".into());
        let expected =
            ["1 animations ignored: walk", "5 extensions ignored: EXT_0, EXT_1, EXT_2, …"].map(String::from);
        assert_eq!(notices.into_messages(), expected);
    }
}
