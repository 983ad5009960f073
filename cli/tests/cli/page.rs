use crate::Folder;
use std::process::Command;

/// The page's own account of itself, on its root element: whether its script ran to the end, which error stopped it, how many points it drew.
fn root_element(browser: &str, page: &std::path::Path) -> String {
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000", "--dump-dom"])
        .arg(format!("file://{}", page.display()))
        .output()
        .expect("TWINLIGHT_BROWSER names a browser");
    let dom = String::from_utf8_lossy(&output.stdout).into_owned();
    let begin = dom.find("<html").unwrap_or_else(|| panic!("no page in {output:?}"));
    dom[begin..].split('>').next().unwrap_or_default().to_owned()
}

/// Pages draw what was measured. `. scripts/browser.sh` makes a browser available; without one there is nothing to see.
#[test]
fn pages_open_in_a_browser() {
    let Ok(browser) = std::env::var("TWINLIGHT_BROWSER") else {
        println!("skipped: TWINLIGHT_BROWSER names no browser");
        return;
    };
    let folder = Folder::new();
    let flags = ["--size", "16x16", "--backend", "cpu", "--quick", "--reference-spp", "16", "--out", "study"];
    folder.run(&[&["cost", "builtin:cornell"], &flags[..]].concat()).ok();
    let study: serde_json::Value = serde_json::from_slice(&folder.read("study/cost.json")).unwrap();
    let points = study["points"].as_array().unwrap().len();
    let page = folder.path("study/cost.html");
    let root = root_element(&browser, &page);
    assert!(root.contains(r#"data-ready="true""#) && !root.contains("data-error"), "{root}");
    assert!(root.contains(&format!(r#"data-points="{points}""#)), "{points} points, {root}");
    // A page whose data is broken says so.
    let html = String::from_utf8(folder.read("study/cost.html")).unwrap();
    folder.write("broken.html", &html.replacen("\"points\":", "\"points\":]", 1));
    let root = root_element(&browser, &folder.path("broken.html"));
    assert!(root.contains("data-error") && !root.contains("data-ready"), "{root}");
}
