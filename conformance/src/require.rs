//! When a missing adapter is a failure instead of a skip.

/// Environment variable: `1` turns missing adapters into failures.
pub const REQUIRE_GPU: &str = "TWINLIGHT_REQUIRE_GPU";

/// Whether the environment demands adapters.
pub fn gpu_required() -> bool {
    std::env::var(REQUIRE_GPU).is_ok_and(|value| value == "1")
}

/// The software adapters every Linux machine can have: (name in reports, what to look for in an adapter's name or
/// driver, in lower case).
pub const SOFTWARE: [(&str, &str); 2] = [("lavapipe", "llvmpipe"), ("SwiftShader", "swiftshader")];

/// What is missing among adapters that describe themselves so, when adapters are demanded.
pub fn missing(adapters: &[String], linux: bool) -> Vec<&'static str> {
    if !linux {
        return if adapters.is_empty() { vec!["any GPU adapter"] } else { Vec::new() };
    }
    let has = |wanted: &str| adapters.iter().any(|name| name.to_lowercase().contains(wanted));
    SOFTWARE.iter().filter(|(_, wanted)| !has(wanted)).map(|&(name, _)| name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linux_needs_both_software_adapters() {
        let both = ["llvmpipe (LLVM 15)".to_owned(), "SwiftShader Device (Subzero)".to_owned()];
        assert!(missing(&both, true).is_empty());
        assert_eq!(missing(&both[..1], true), ["SwiftShader"]);
        assert_eq!(missing(&[], true), ["lavapipe", "SwiftShader"]);
        assert_eq!(missing(&[], false), ["any GPU adapter"]);
        assert!(missing(&["Apple M2".to_owned()], false).is_empty());
    }
}
