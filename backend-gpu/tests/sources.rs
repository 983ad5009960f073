//! Every WGSL source parses, validates, fits the smallest adapter, and uses no builtin on which adapters disagree.
//! Needs no GPU.

use naga::{AddressSpace, Expression, MathFunction, TypeInner};
use twinlight_backend_gpu::kernels;
use twinlight_backend_gpu::reflect::{self, Access};
use twinlight_backend_gpu::source::{CheckedModule, KernelSource, WgslFile};
use twinlight_backend_gpu::strict;
use twinlight_core::accuracy::Accuracy;
use twinlight_core::kernels as contracts;

/// Functions that a kernel may call. Not in it: whatever two adapters of ours were seen to compute differently
/// (normalize, mix, fract, smoothstep, step, unpack*, pack2x16float, every transcendental), and what WGSL lets real
/// GPUs approximate and CPUs not (fma, inverseSqrt). `length`, `cross` and `dot` have one definition each, but their
/// results are decorated only where they are plain instructions: kernels spell length and cross out.
const ALLOWED: &[MathFunction] = &[
    MathFunction::Abs,
    MathFunction::Ceil,
    MathFunction::Floor,
    MathFunction::Round,
    MathFunction::Trunc,
    MathFunction::Sqrt,
    MathFunction::Dot,
    MathFunction::CountTrailingZeros,
    MathFunction::CountLeadingZeros,
    MathFunction::CountOneBits,
    MathFunction::ReverseBits,
    MathFunction::ExtractBits,
    MathFunction::InsertBits,
    MathFunction::FirstTrailingBit,
    MathFunction::FirstLeadingBit,
];

/// Functions that are exact on integers, but on floats disagree about NaN, -0 or infinity.
const INTEGERS_ONLY: &[MathFunction] =
    &[MathFunction::Min, MathFunction::Max, MathFunction::Clamp, MathFunction::Sign];

#[test]
fn every_source_parses_and_validates() {
    for source in kernels::ALL {
        let checked = source.check().unwrap_or_else(|error| panic!("{error}"));
        assert!(!checked.module.entry_points.is_empty(), "{} has no entry point", source.stem);
    }
}

#[test]
fn no_source_uses_a_banned_builtin() {
    for source in kernels::ALL {
        let banned = banned_expressions(source, &source.check().expect("checked above"));
        assert!(banned.is_empty(), "{banned:#?}");
    }
}

#[test]
fn banned_builtins_are_found() {
    // The negative control: one line each, and the control of the control: what is allowed is not reported. The 16-bit
    // conversions are missing because validation refuses them already.
    let allowed = "let y = sqrt(abs(x)) + floor(x) + dot(v, v) + f32(min(u, 3u)) + f32(u % 3u) - trunc(x);";
    assert_eq!(probe(allowed), Vec::<String>::new());
    let banned = [
        "normalize(v).x",
        "mix(x, 1.5, 0.25)",
        "x % 3.0",
        "fract(x)",
        "smoothstep(0.0, 1.0, x)",
        "fma(x, x, x)",
        "inverseSqrt(x)",
        "step(0.5, x)",
        "unpack4x8unorm(u).x",
        "sin(x)",
        "cos(x)",
        "tan(x)",
        "exp(x)",
        "exp2(x)",
        "log(x)",
        "log2(x)",
        "pow(x, 2.5)",
        "atan2(x, 2.0)",
        "acos(x)",
        "min(x, 1.0)",
        "max(x, 1.0)",
        "clamp(x, 0.0, 1.0)",
        "saturate(x)",
        "sign(x)",
        "length(v)",
        "cross(v, v).x",
        "distance(v, v)",
        "reflect(v, v).x",
        "ldexp(x, 3)",
        "(v % v).x",
    ];
    for expression in banned {
        let found = probe(&format!("let y = {expression};"));
        assert_eq!(found.len(), 1, "{expression}: {found:?}");
    }
}

/// What an adapter may do to floats, fuse, reassociate, flush or miss by units in the last place, can't move what has none.
#[test]
fn exact_kernels_have_no_floats() {
    let exact = [
        ("scan", contracts::scan::ACCURACY),
        ("sort", contracts::sort::ACCURACY),
        ("rasterize_lhb", contracts::rasterize_lhb::ACCURACY),
        ("merge_lhb", contracts::merge_lhb::ACCURACY),
        ("pack_lhb", contracts::pack_lhb::ACCURACY),
        ("query_lhb", contracts::query_lhb::ACCURACY),
        ("reduce_mips", contracts::reduce_mips::ACCURACY),
        ("voxelize", contracts::voxelize::ACCURACY),
        ("sum_voxels", contracts::sum_voxels::ACCURACY),
    ];
    let has_floats = |source: &KernelSource| {
        let module = source.check().expect("checked above").module;
        module.types.iter().any(|(_, ty)| is_float(&ty.inner))
    };
    for (stem, accuracy) in exact {
        assert!(matches!(accuracy, Accuracy::Exact { .. }), "{stem}: {accuracy:?}");
        let source = kernels::ALL.iter().find(|source| source.stem == stem).expect("a kernel");
        assert!(!has_floats(source), "{stem} has a float");
    }
    // The control, and the list is whole.
    let with_floats = kernels::ALL.iter().filter(|source| has_floats(source)).count();
    assert_eq!(with_floats + exact.len(), kernels::ALL.len());
}

#[test]
fn every_entry_point_fits_the_smallest_adapter() {
    for source in kernels::ALL {
        let checked = source.check().expect("checked above");
        for entry_point in &checked.module.entry_points {
            let interface =
                reflect::interface(&checked, &entry_point.name).unwrap_or_else(|error| panic!("{error}"));
            let storage =
                interface.bindings.iter().filter(|binding| binding.access != Access::Uniform).count();
            assert!(storage <= 8, "{}: {storage} storage buffers", entry_point.name);
            assert!(interface.bindings.len() - storage <= 1, "{}: one uniform, params", entry_point.name);
            let invocations: u32 = interface.workgroup_size.iter().product();
            assert!(invocations <= 256, "{}: {invocations} invocations", entry_point.name);
            let bytes = interface.workgroup_bytes;
            assert!(bytes <= 16 * 1024, "{}: {bytes} bytes of workgroup memory", entry_point.name);
        }
    }
}

#[test]
fn strict_mode_decorates_every_float_operation() {
    const TEXT: &str = "
@group(0) @binding(0) var<storage, read_write> values: array<f32>;
@compute @workgroup_size(1)
fn probe() {
    let x = values[0];
    let v = vec3<f32>(x, values[1], values[2]);
    values[0] = -x + x * x - x / 3.0 + dot(v * 2.0, v);
    values[1] = f32(u32(x) + 7u);
}";
    let source = KernelSource { stem: "probe", files: &[WgslFile { path: "probe.wgsl", text: TEXT }] };
    let checked = source.check().expect("valid");
    let interface = reflect::interface(&checked, "probe").expect("an entry point");
    let words = strict::compile(&checked, &interface).expect("SPIR-V");
    let (mut decorated, mut float_results) = (Vec::new(), Vec::new());
    let mut at = 5;
    while at < words.len() {
        let (opcode, length) = (words[at] & 0xffff, (words[at] >> 16) as usize);
        match opcode {
            71 if words[at + 2] == 42 => decorated.push(words[at + 1]),
            127 | 129 | 131 | 133 | 136 | 142 | 148 => float_results.push(words[at + 2]),
            _ => {}
        }
        at += length;
    }
    // -x, +, *, -, /, +, dot, v * 2.
    assert_eq!(float_results.len(), 8);
    decorated.sort_unstable();
    float_results.sort_unstable();
    assert_eq!(decorated, float_results);
    assert!(strict::forbid_contraction(vec![0; 5]).is_err());
    assert!(strict::forbid_contraction(vec![0, 0, 0, 0, 0, 9 << 16 | 129]).is_err());
}

#[test]
fn errors_are_reported_at_their_own_file_and_line() {
    const FIRST: WgslFile = WgslFile { path: "a.wgsl", text: "const A: u32 = 1u;\n// end" };
    const BAD: WgslFile = WgslFile { path: "b.wgsl", text: "const B: u32 = A;\n  const C: u32 = D;\n" };
    const WRONG: WgslFile = WgslFile { path: "c.wgsl", text: "\nfn f() {\n    let x: u32 = 1.5;\n}\n" };
    let text_of = |files| KernelSource { stem: "joined", files }.check().expect_err("must fail").to_string();
    assert!(text_of(&[FIRST, BAD]).contains("b.wgsl:2:18: "), "{}", text_of(&[FIRST, BAD]));
    assert!(text_of(&[FIRST, WRONG]).contains("c.wgsl:3:"), "{}", text_of(&[FIRST, WRONG]));
}

fn probe(line: &str) -> Vec<String> {
    let text = format!(
        "@group(0) @binding(0) var<storage, read_write> values: array<f32>;
@compute @workgroup_size(1)
fn probe() {{
    let x = values[0];
    let v = vec3<f32>(x, values[1], values[2]);
    let u = u32(x);
    {line}
    values[0] = y;
}}"
    );
    let files: &'static [WgslFile] = vec![WgslFile { path: "probe.wgsl", text: text.leak() }].leak();
    let source = KernelSource { stem: "probe", files };
    banned_expressions(&source, &source.check().unwrap_or_else(|error| panic!("{line}: {error}")))
}

/// Place and name of every banned expression.
fn banned_expressions(source: &KernelSource, checked: &CheckedModule) -> Vec<String> {
    let module = &checked.module;
    let mut banned = Vec::new();
    let mut visit = |function: &naga::Function, info: &naga::valid::FunctionInfo| {
        for (handle, expression) in function.expressions.iter() {
            let float =
                |handle: naga::Handle<Expression>| is_float(info[handle].ty.inner_with(&module.types));
            let name = match *expression {
                Expression::Math { fun, arg, .. } if INTEGERS_ONLY.contains(&fun) => {
                    float(arg).then(|| format!("{fun:?} of floats"))
                }
                Expression::Math { fun, .. } => (!ALLOWED.contains(&fun)).then(|| format!("{fun:?}")),
                Expression::Binary { op: naga::BinaryOperator::Modulo, left, .. } => {
                    float(left).then(|| "% of floats".to_owned())
                }
                Expression::SubgroupBallotResult | Expression::SubgroupOperationResult { .. } => {
                    Some("a subgroup operation".to_owned())
                }
                _ => None,
            };
            if let Some(name) = name {
                let span = function.expressions.get_span(handle).to_range().unwrap_or_default();
                banned.push(format!("{}: {name}", source.locate(span.start)));
            }
        }
    };
    for (handle, function) in module.functions.iter() {
        visit(function, &checked.info[handle]);
    }
    for (index, entry_point) in module.entry_points.iter().enumerate() {
        visit(&entry_point.function, checked.info.get_entry_point(index));
    }
    for (_, global) in module.global_variables.iter() {
        if global.space == AddressSpace::Handle {
            banned.push(format!("{}: a texture or sampler", source.stem));
        }
    }
    banned
}

fn is_float(ty: &TypeInner) -> bool {
    ty.scalar_kind() == Some(naga::ScalarKind::Float)
}
