//! Arrays of numbers, every offset checked before it is used.

use super::Document;
use super::buffer::ViewBytes;
use ::gltf::json::accessor::{Accessor, ComponentType, GenericComponentType, IndexComponentType, Type};
use ::gltf::json::validation::Checked;
use ::gltf::json::{self, Index};
use twinlight_core::{Error, Result};

/// Elements of an accessor without a buffer view, which costs the file nothing.
const MAX_ZEROS: u64 = 1 << 24;

/// A checked array of elements in a view: all of `count` strides lie within it.
struct Elements<'a> {
    view: ViewBytes<'a>,
    offset: usize,
    stride: usize,
    size: usize,
    count: usize,
}

impl Elements<'_> {
    fn iter(&self) -> impl Iterator<Item = &[u8]> {
        let bytes = &self.view.bytes()[self.offset..];
        (0..self.count).map(move |i| &bytes[i * self.stride..][..self.size])
    }
}

/// What an accessor says of its elements.
struct Shape {
    component: ComponentType,
    components: usize,
    count: u64,
}

impl<'a> Document<'a> {
    /// The elements of a float attribute with `N` components. Integers become floats as they are, or scaled to 0…1 (signed:
    /// −1…1) when the accessor is normalised.
    pub fn floats<const N: usize>(&self, index: Index<Accessor>, path: &str) -> Result<Vec<[f32; N]>> {
        let (accessor, shape) = self.accessor(index, path, N)?;
        let path = format!("accessors[{}]", index.value());
        let mut values = self.filled([0.0; N], accessor, &shape, &path)?;
        let element = |bytes: &[u8]| {
            let mut components = bytes.chunks_exact(shape.component.size());
            [(); N]
                .map(|()| components.next().map_or(0.0, |c| decode(shape.component, accessor.normalized, c)))
        };
        if let Some(view) = accessor.buffer_view {
            let offset = accessor.byte_offset.unwrap_or_default().0;
            let elements = self.elements(view, offset, &shape, true, &path)?;
            values.iter_mut().zip(elements.iter()).for_each(|(v, bytes)| *v = element(bytes));
        }
        self.apply_sparse(accessor, &shape, &path, |i, bytes| values[i] = element(bytes))?;
        Ok(values)
    }

    /// Vertex indices of a primitive.
    pub fn indices(&self, index: Index<Accessor>, path: &str) -> Result<Vec<u32>> {
        let (accessor, shape) = self.accessor(index, path, 1)?;
        let path = format!("accessors[{}]", index.value());
        if !matches!(shape.component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32) {
            let what = format!("vertex indices of type {:?}, not unsigned integers", shape.component);
            return Err(self.invalid(&path, what));
        }
        let mut values = self.filled(0, accessor, &shape, &path)?;
        if let Some(view) = accessor.buffer_view {
            let offset = accessor.byte_offset.unwrap_or_default().0;
            let elements = self.elements(view, offset, &shape, true, &path)?;
            values.iter_mut().zip(elements.iter()).for_each(|(v, bytes)| *v = unsigned(bytes));
        }
        self.apply_sparse(accessor, &shape, &path, |i, bytes| values[i] = unsigned(bytes))?;
        Ok(values)
    }

    /// Four joints per vertex, indices into a skin's list.
    pub fn joint_indices(&self, index: Index<Accessor>, path: &str) -> Result<Vec<[u32; 4]>> {
        let (accessor, shape) = self.accessor(index, path, 4)?;
        if !matches!(shape.component, ComponentType::U8 | ComponentType::U16) || accessor.normalized {
            let what = format!("joints of type {:?}, not unsigned bytes or shorts", shape.component);
            return Err(self.invalid(&format!("accessors[{}]", index.value()), what));
        }
        // 16 bits fit a float as they are.
        Ok(self
            .floats::<4>(index, path)?
            .into_iter()
            .map(|joints| joints.map(|joint| joint as u32))
            .collect())
    }

    fn accessor(
        &self,
        index: Index<Accessor>,
        path: &str,
        components: usize,
    ) -> Result<(&'a Accessor, Shape)> {
        let root: &'a json::Root = self.root;
        let accessor = self.get(&root.accessors, index, "accessor", path)?;
        let Checked::Valid(GenericComponentType(component)) = accessor.component_type else {
            return Err(self.invalid(&format!("accessors[{}]", index.value()), "has no valid component type"));
        };
        let found = match accessor.type_ {
            Checked::Valid(Type::Scalar) => 1,
            Checked::Valid(Type::Vec2) => 2,
            Checked::Valid(Type::Vec3) => 3,
            Checked::Valid(Type::Vec4) => 4,
            Checked::Valid(Type::Mat4) => 16,
            _ => 0,
        };
        if found != components {
            let what = format!("has elements of type {:?}, {components} components needed", accessor.type_);
            return Err(self.invalid(&format!("accessors[{}]", index.value()), what));
        }
        Ok((accessor, Shape { component, components, count: accessor.count.0 }))
    }

    /// `zero` for every element; the count is held against the data, or without data against [`MAX_ZEROS`], and then
    /// against the limits.
    fn filled<T: Copy>(&self, zero: T, accessor: &Accessor, shape: &Shape, path: &str) -> Result<Vec<T>> {
        match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.unwrap_or_default().0;
                self.elements(view, offset, shape, true, path)?;
            }
            None if shape.count > MAX_ZEROS => {
                let what = format!("{}: {path}: elements without data", self.name);
                return Err(Error::limit(what, shape.count, MAX_ZEROS));
            }
            None => {}
        }
        let place = || format!("{}: {path}", self.name);
        self.budget.spend(place, shape.count, size_of::<T>() as u64)?;
        Ok(vec![zero; shape.count as usize])
    }

    /// `shape.count` elements from `offset` of a view. `strided`: whether the view's stride applies.
    fn elements(
        &self,
        view: Index<json::buffer::View>,
        offset: u64,
        shape: &Shape,
        strided: bool,
        path: &str,
    ) -> Result<Elements<'a>> {
        let view = self.view(view, path)?;
        let size = shape.component.size() * shape.components;
        let stride = view.stride.filter(|_| strided).unwrap_or(size);
        if stride < size {
            return Err(
                self.invalid(path, format!("stride {stride} is less than the element's {size} bytes"))
            );
        }
        let before_last = shape.count.saturating_sub(1).checked_mul(stride as u64);
        let needed = before_last.and_then(|b| b.checked_add(if shape.count == 0 { 0 } else { size as u64 }));
        let end = needed.and_then(|n| n.checked_add(offset));
        let available = view.bytes().len() as u64;
        if end.is_none_or(|end| end > available) {
            let what = format!(
                "{} elements of {size} bytes, stride {stride}, from byte {offset} of a view of {available}",
                shape.count
            );
            return Err(self.invalid(path, what));
        }
        Ok(Elements { view, offset: offset as usize, stride, size, count: shape.count as usize })
    }

    /// Calls `replace` with the position and the new bytes of every sparse element.
    fn apply_sparse(
        &self,
        accessor: &Accessor,
        shape: &Shape,
        path: &str,
        mut replace: impl FnMut(usize, &[u8]),
    ) -> Result<()> {
        let Some(sparse) = &accessor.sparse else { return Ok(()) };
        let path = format!("{path}.sparse");
        let Checked::Valid(IndexComponentType(component)) = sparse.indices.component_type else {
            return Err(self.invalid(&path, "indices have no valid component type"));
        };
        let count = sparse.count.0;
        let of_indices = Shape { component, components: 1, count };
        let indices = self.elements(
            sparse.indices.buffer_view,
            sparse.indices.byte_offset.0,
            &of_indices,
            false,
            &path,
        )?;
        let of_values = Shape { component: shape.component, components: shape.components, count };
        let values =
            self.elements(sparse.values.buffer_view, sparse.values.byte_offset.0, &of_values, false, &path)?;
        for (index, value) in indices.iter().map(unsigned).zip(values.iter()) {
            if u64::from(index) >= shape.count {
                return Err(self.invalid(&path, format!("index {index} of {} elements", shape.count)));
            }
            replace(index as usize, value);
        }
        Ok(())
    }
}

/// A little-endian unsigned integer of 1, 2 or 4 bytes.
fn unsigned(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |value, &byte| value << 8 | u32::from(byte))
}

fn decode(component: ComponentType, normalized: bool, bytes: &[u8]) -> f32 {
    let bits = unsigned(bytes);
    let (value, largest) = match component {
        ComponentType::F32 => return f32::from_bits(bits),
        ComponentType::U8 => (bits as f32, 255.0),
        ComponentType::U16 => (bits as f32, 65535.0),
        ComponentType::U32 => (bits as f32, u32::MAX as f32),
        ComponentType::I8 => (f32::from(bits as u8 as i8), 127.0),
        ComponentType::I16 => (f32::from(bits as u16 as i16), 32767.0),
    };
    if normalized { (value / largest).max(-1.0) } else { value }
}
