//! The processor's name, for reports.

/// The processor's name for itself, or the architecture where it has none.
#[cfg(target_arch = "x86_64")]
#[allow(unused_unsafe, reason = "newer compilers declare __cpuid safe")]
pub(crate) fn name() -> String {
    use std::arch::x86_64::__cpuid;
    // SAFETY: every x86-64 processor has cpuid.
    let last = unsafe { __cpuid(0x8000_0000) }.eax;
    if last < 0x8000_0004 {
        return std::env::consts::ARCH.to_owned();
    }
    let mut bytes = Vec::with_capacity(48);
    for leaf in 0x8000_0002..=0x8000_0004_u32 {
        // SAFETY: the leaf is at most `last`.
        let part = unsafe { __cpuid(leaf) };
        bytes.extend([part.eax, part.ebx, part.ecx, part.edx].into_iter().flat_map(u32::to_le_bytes));
    }
    let text = String::from_utf8_lossy(&bytes);
    text.trim_matches(|c: char| c == '\0' || c.is_whitespace()).to_owned()
}

/// The processor's name for itself, or the architecture where it has none.
#[cfg(not(target_arch = "x86_64"))]
pub(crate) fn name() -> String {
    std::env::consts::ARCH.to_owned()
}
