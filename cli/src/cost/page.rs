//! The page: one file that asks the network for nothing.

use super::records::Words;
use serde_json::Value;

const PAGE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/page.css");
const SCRIPT: &str = include_str!("page/page.js");

/// A setting in a line.
pub fn title(setting: &Words) -> String {
    let flags = setting.flags.iter().map(|(flag, value)| format!(" {flag} {value}"));
    setting.method.clone() + &flags.collect::<String>()
}

/// The page of a study, which `name` is the scene of.
pub fn html(name: &str, study: &Value) -> String {
    fill(PAGE, &[("title", &escaped(name)), ("style", STYLE), ("script", SCRIPT), ("data", &inlined(study))])
}

/// Puts texts where `{{name}}` is, once each and in one go: a text may hold what looks like a place.
fn fill(page: &str, texts: &[(&str, &str)]) -> String {
    let mut filled = String::new();
    let mut rest = page;
    while let Some((before, after)) = rest.split_once("{{") {
        let place = after.split_once("}}");
        let text = place.and_then(|(name, _)| texts.iter().find(|(known, _)| *known == name));
        filled += before;
        match (place, text) {
            (Some((_, behind)), Some((_, text))) => {
                filled += text;
                rest = behind;
            }
            _ => {
                filled += "{{";
                rest = after;
            }
        }
    }
    filled + rest
}

/// JSON that no end of a script and no comment hides in: strings are the only place for a `<`.
fn inlined(value: &Value) -> String {
    value.to_string().replace('<', "\\u003c")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn every_place_is_filled_and_nothing_breaks_out() {
        let evil = "</script><!-- {{style}} & \"x\"";
        let page = html(evil, &json!({ "name": evil }));
        for place in ["{{title}}", "{{script}}", "{{data}}"] {
            assert!(!page.contains(place), "{place}");
        }
        let (before, after) = page.split_once("id=\"data\">").unwrap();
        assert!(before.contains("&lt;/script&gt;&lt;!-- {{style}} &amp;"));
        let (data, _) = after.split_once("</script>").unwrap();
        assert_eq!(serde_json::from_str::<Value>(data).unwrap(), json!({ "name": evil }));
        assert!(!data.contains('<'));
    }

    #[test]
    fn only_known_places_are_filled() {
        assert_eq!(fill("a{{x}}{{y}}{{x", &[("x", "{{x}}")]), "a{{x}}{{y}}{{x");
    }
}
