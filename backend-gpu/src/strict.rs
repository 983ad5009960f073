//! Strict mode: float arithmetic evaluated as written.
//!
//! WGSL lets a driver fuse and reassociate float operations, and the software adapters do: `(x + y) - x` becomes `y`,
//! `x*y + x*z` becomes `x*(y + z)`. SPIR-V can forbid it per result with the `NoContraction` decoration, which no WGSL
//! construct asks for. So strict mode compiles WGSL to SPIR-V itself, decorates every float result and hands the words
//! to the driver past wgpu's own compiler. Bounds checks and loop bounds, which wgpu would add, are added here.

use crate::reflect::Interface;
use crate::source::CheckedModule;
use naga::back::spv;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use twinlight_core::{Error, Result};

/// How float arithmetic is compiled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Every float operation rounds as written: `NoContraction` SPIR-V through passthrough (Vulkan only).
    Strict,
    /// Plain WGSL through wgpu: the driver may fuse and reassociate within WGSL's accuracy table.
    Portable,
}

impl Mode {
    /// `strict` or `portable`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Strict => "strict",
            Self::Portable => "portable",
        }
    }
}

/// Words before the first instruction: magic, version, generator, bound, schema.
const HEADER_WORDS: usize = 5;
const OP_TYPE_FIRST: u32 = 19;
const OP_TYPE_LAST: u32 = 39;
const OP_DECORATE: u32 = 71;
const DECORATION_NO_CONTRACTION: u32 = 42;
/// FNegate FAdd FSub FMul FDiv FRem FMod VectorTimesScalar MatrixTimesScalar VectorTimesMatrix MatrixTimesVector
/// MatrixTimesMatrix OuterProduct Dot.
const FLOAT_ARITHMETIC: [u32; 14] = [127, 129, 131, 133, 136, 140, 141, 142, 143, 144, 145, 146, 147, 148];

/// SPIR-V of one entry point with every float result decorated.
///
/// # Errors
/// [`Error::Internal`] when naga can't express the module.
pub fn compile(checked: &CheckedModule, interface: &Interface) -> Result<Vec<u32>> {
    let options = spv::Options {
        lang_version: (1, 0),
        flags: spv::WriterFlags::empty(),
        fake_missing_bindings: false,
        binding_map: binding_map(interface),
        capabilities: Some([spv::Capability::Shader, spv::Capability::Matrix].into_iter().collect()),
        bounds_check_policies: BoundsCheckPolicies {
            index: BoundsCheckPolicy::Restrict,
            buffer: BoundsCheckPolicy::Restrict,
            image_load: BoundsCheckPolicy::Restrict,
            binding_array: BoundsCheckPolicy::Restrict,
        },
        // As in portable mode (`pipeline.rs`): kernels write workgroup memory before they read it.
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::None,
        force_loop_bounding: true,
        ..spv::Options::default()
    };
    let entry_point = spv::PipelineOptions {
        shader_stage: naga::ShaderStage::Compute,
        entry_point: interface.entry_point.clone(),
    };
    let words = spv::write_vec(&checked.module, &checked.info, &options, Some(&entry_point))
        .map_err(|error| Error::Internal(format!("SPIR-V of {}: {error}", interface.entry_point)))?;
    forbid_contraction(words)
}

/// wgpu's Vulkan layer numbers the bindings of a layout 0, 1, 2… in ascending order; SPIR-V that bypasses it must too.
fn binding_map(interface: &Interface) -> spv::BindingMap {
    interface
        .bindings
        .iter()
        .zip(0u32..)
        .map(|(binding, slot)| {
            let source = naga::ResourceBinding { group: 0, binding: binding.binding };
            (source, spv::BindingInfo { descriptor_set: 0, binding: slot, binding_array_size: None })
        })
        .collect()
}

/// Adds `OpDecorate result NoContraction` for every float arithmetic instruction.
///
/// # Errors
/// [`Error::Internal`] when the words are not a SPIR-V module.
pub fn forbid_contraction(words: Vec<u32>) -> Result<Vec<u32>> {
    let malformed = || Error::Internal("malformed SPIR-V".into());
    let mut decorations = Vec::new();
    let mut first_type = None;
    let mut at = HEADER_WORDS;
    while at < words.len() {
        let (opcode, length) = (words[at] & 0xffff, (words[at] >> 16) as usize);
        if length == 0 || at + length > words.len() {
            return Err(malformed());
        }
        if first_type.is_none() && (OP_TYPE_FIRST..=OP_TYPE_LAST).contains(&opcode) {
            first_type = Some(at);
        }
        if FLOAT_ARITHMETIC.contains(&opcode) {
            let result = *words.get(at + 2).ok_or_else(malformed)?;
            decorations.extend([3 << 16 | OP_DECORATE, result, DECORATION_NO_CONTRACTION]);
        }
        at += length;
    }
    // Annotations stand between the names and the first type (SPIR-V 2.4, logical layout).
    let first_type = first_type.ok_or_else(malformed)?;
    let mut decorated = words;
    decorated.splice(first_type..first_type, decorations);
    Ok(decorated)
}
