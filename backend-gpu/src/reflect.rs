//! What an entry point needs, read from the parsed WGSL instead of being written down twice.

use crate::source::CheckedModule;
use twinlight_core::{Error, Result};

/// How a shader uses a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// `var<uniform>`.
    Uniform,
    /// `var<storage, read>`.
    Read,
    /// `var<storage, read_write>`.
    ReadWrite,
}

/// One buffer of an entry point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Binding {
    /// Name of the WGSL variable.
    pub name: String,
    /// Its `@binding`; the group is always 0.
    pub binding: u32,
    /// Its address space and access.
    pub access: Access,
    /// Size of its type in bytes, with one element of a runtime-sized array.
    pub min_bytes: u64,
}

/// An entry point as the host sees it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Interface {
    /// Name of the function.
    pub entry_point: String,
    /// Invocations per workgroup.
    pub workgroup_size: [u32; 3],
    /// Bytes of workgroup memory.
    pub workgroup_bytes: u64,
    /// The buffers it uses (not those it only declares), by ascending `@binding`.
    pub bindings: Vec<Binding>,
}

/// Reads the interface of `entry_point`.
///
/// # Errors
/// [`Error::Internal`] when there is no such entry point, or when it uses anything but buffers in group 0.
pub fn interface(checked: &CheckedModule, entry_point: &str) -> Result<Interface> {
    let module = &checked.module;
    let index = module
        .entry_points
        .iter()
        .position(|candidate| candidate.name == entry_point)
        .ok_or_else(|| Error::Internal(format!("no entry point {entry_point}")))?;
    let uses = checked.info.get_entry_point(index);
    let mut bindings = Vec::new();
    let mut workgroup_bytes = 0;
    for (handle, global) in module.global_variables.iter() {
        if uses[handle].is_empty() {
            continue;
        }
        let bytes = u64::from(module.types[global.ty].inner.size(module.to_ctx()));
        let name = global.name.clone().unwrap_or_default();
        let access = match global.space {
            naga::AddressSpace::WorkGroup => {
                workgroup_bytes += bytes;
                continue;
            }
            naga::AddressSpace::Private => continue,
            naga::AddressSpace::Uniform => Access::Uniform,
            naga::AddressSpace::Storage { access } if access.contains(naga::StorageAccess::STORE) => {
                Access::ReadWrite
            }
            naga::AddressSpace::Storage { .. } => Access::Read,
            _ => return Err(Error::Internal(format!("{entry_point}: {name} is not a buffer"))),
        };
        match global.binding {
            Some(naga::ResourceBinding { group: 0, binding }) => {
                bindings.push(Binding { name, binding, access, min_bytes: bytes });
            }
            _ => return Err(Error::Internal(format!("{entry_point}: {name} is not in group 0"))),
        }
    }
    bindings.sort_by_key(|binding| binding.binding);
    let workgroup_size = module.entry_points[index].workgroup_size;
    Ok(Interface { entry_point: entry_point.to_owned(), workgroup_size, workgroup_bytes, bindings })
}
