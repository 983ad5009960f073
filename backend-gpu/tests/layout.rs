//! WGSL structs and constants equal their Rust twins: names, offsets, sizes, values. Needs no GPU.
//!
//! Each kernel adds one [`Twins`] to [`twins`]. A Rust field that is missing in the table fails to compile only if it
//! is misspelt; one that is left out shows as a WGSL field that nothing answers to.

use std::mem::{offset_of, size_of};
use twinlight_backend_gpu::kernels::{self, scan, sort};
use twinlight_backend_gpu::source::{CheckedModule, KernelSource, WgslFile};

/// A Rust struct: name, size, and its fields with their offsets.
struct Layout {
    name: &'static str,
    size: usize,
    fields: Vec<(&'static str, usize)>,
}

/// `layout!(Type { field, … })`, fields in the order of the WGSL struct of the same name.
macro_rules! layout {
    ($module:ident :: $name:ident { $($field:ident),* $(,)? }) => {
        Layout {
            name: stringify!($name),
            size: size_of::<$module::$name>(),
            fields: vec![$((stringify!($field), offset_of!($module::$name, $field))),*],
        }
    };
}

struct Twins {
    source: &'static KernelSource,
    structs: Vec<Layout>,
    constants: Vec<(&'static str, u32)>,
}

fn twins() -> Vec<Twins> {
    vec![
        Twins {
            source: &scan::SOURCE,
            structs: vec![layout!(scan::ScanParams { count, tile_count })],
            constants: vec![("TILE_SIZE", scan::TILE_SIZE)],
        },
        Twins {
            source: &sort::SOURCE,
            structs: vec![layout!(sort::SortParams { count, tile_count, key_words, word, shift })],
            constants: vec![
                ("TILE_SIZE", sort::TILE_SIZE),
                ("DIGIT_BITS", sort::DIGIT_BITS),
                ("DIGITS", sort::DIGITS),
            ],
        },
    ]
}

#[test]
fn every_kernel_has_a_row() {
    for source in kernels::ALL {
        let rows = twins().iter().filter(|twins| twins.source.stem == source.stem).count();
        assert_eq!(rows, 1, "{}", source.stem);
    }
}

#[test]
fn structs_and_constants_agree() {
    for twins in twins() {
        let checked = twins.source.check().unwrap_or_else(|error| panic!("{error}"));
        for layout in &twins.structs {
            if let Err(difference) = compare_struct(&checked, layout) {
                panic!("{}: {difference}", twins.source.stem);
            }
        }
        for &(name, value) in &twins.constants {
            if let Err(difference) = compare_constant(&checked, name, value) {
                panic!("{}: {difference}", twins.source.stem);
            }
        }
    }
}

#[test]
fn every_struct_of_a_buffer_is_in_the_table() {
    for twins in twins() {
        let checked = twins.source.check().unwrap_or_else(|error| panic!("{error}"));
        let module = &checked.module;
        for (_, global) in module.global_variables.iter().filter(|(_, global)| global.binding.is_some()) {
            let mut ty = &module.types[global.ty];
            while let naga::TypeInner::Array { base, .. } = ty.inner {
                ty = &module.types[base];
            }
            if let (naga::TypeInner::Struct { .. }, Some(name)) = (&ty.inner, &ty.name) {
                let listed = twins.structs.iter().any(|layout| layout.name == name);
                assert!(listed, "{}: {name} of {:?} has no twin", twins.source.stem, global.name);
            }
        }
    }
}

/// The workgroup sizes that the indices in the WGSL assume.
#[test]
fn workgroup_sizes_are_those_of_the_constants() {
    for twins in twins() {
        let checked = twins.source.check().unwrap_or_else(|error| panic!("{error}"));
        for entry_point in &checked.module.entry_points {
            let size: u32 = entry_point.workgroup_size.iter().product();
            if let Err(difference) = compare_constant(&checked, "WORKGROUP_SIZE", size) {
                panic!("{} / {}: {difference}", twins.source.stem, entry_point.name);
            }
        }
    }
}

#[test]
fn a_wrong_twin_is_named() {
    const TEXT: &str = "
struct Probe { a: u32, b: vec3<f32>, c: u32 }
const SIZE: u32 = 3u;
@group(0) @binding(0) var<uniform> params: Probe;
@compute @workgroup_size(1) fn probe() { _ = params.a; }";
    let source = KernelSource { stem: "probe", files: &[WgslFile { path: "probe.wgsl", text: TEXT }] };
    let checked = source.check().expect("valid");
    let probe = |size, fields| compare_struct(&checked, &Layout { name: "Probe", size, fields });
    assert_eq!(probe(32, vec![("a", 0), ("b", 16), ("c", 28)]), Ok(()));
    let wrong = [
        (probe(32, vec![("a", 0), ("b", 4), ("c", 28)]), "field b is at 16 in WGSL, at 4 in Rust"),
        (probe(32, vec![("a", 0), ("c", 16), ("b", 28)]), "field b in WGSL is c in Rust"),
        (probe(32, vec![("a", 0), ("b", 16)]), "field c is only in WGSL"),
        (probe(32, vec![("a", 0), ("b", 16), ("c", 28), ("d", 32)]), "field d is only in Rust"),
        (probe(28, vec![("a", 0), ("b", 16), ("c", 28)]), "32 bytes in WGSL, 28 in Rust"),
    ];
    for (result, expected) in wrong {
        assert_eq!(result, Err(format!("Probe: {expected}")));
    }
    assert_eq!(compare_constant(&checked, "SIZE", 3), Ok(()));
    assert!(compare_constant(&checked, "SIZE", 4).is_err());
    assert!(compare_constant(&checked, "ABSENT", 4).is_err());
}

fn compare_struct(checked: &CheckedModule, layout: &Layout) -> Result<(), String> {
    let name = layout.name;
    let found = checked.module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name));
    let Some((_, naga::Type { inner: naga::TypeInner::Struct { members, span }, .. })) = found else {
        return Err(format!("{name}: no such struct in WGSL"));
    };
    for position in 0..members.len().max(layout.fields.len()) {
        let wgsl =
            members.get(position).map(|member| (member.name.as_deref().unwrap_or_default(), member.offset));
        match (wgsl, layout.fields.get(position)) {
            (Some((field, _)), None) => return Err(format!("{name}: field {field} is only in WGSL")),
            (None, Some((field, _))) => return Err(format!("{name}: field {field} is only in Rust")),
            (Some((wgsl, _)), Some(&(rust, _))) if wgsl != rust => {
                return Err(format!("{name}: field {wgsl} in WGSL is {rust} in Rust"));
            }
            (Some((field, wgsl)), Some(&(_, rust))) if wgsl as usize != rust => {
                return Err(format!("{name}: field {field} is at {wgsl} in WGSL, at {rust} in Rust"));
            }
            _ => {}
        }
    }
    if *span as usize != layout.size {
        return Err(format!("{name}: {span} bytes in WGSL, {} in Rust", layout.size));
    }
    Ok(())
}

fn compare_constant(checked: &CheckedModule, name: &str, value: u32) -> Result<(), String> {
    let module = &checked.module;
    let found = module.constants.iter().find(|(_, constant)| constant.name.as_deref() == Some(name));
    let Some((_, constant)) = found else {
        return Err(format!("{name}: no such constant in WGSL"));
    };
    match module.global_expressions[constant.init] {
        naga::Expression::Literal(naga::Literal::U32(wgsl)) if wgsl == value => Ok(()),
        ref wgsl => Err(format!("{name} is {wgsl:?} in WGSL, {value} in Rust")),
    }
}
