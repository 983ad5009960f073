//! Orthographic views of the lattice.

use crate::error::{Error, Result};
use bytemuck::{Pod, Zeroable};
use glam::DVec3;

/// Most pixels per row and column of a view.
pub const MAX_SIZE: u32 = 1024;

/// Added to the product of a view's `forward` with a position, so that depths are not negative: they lie in
/// (0, 2³⁰).
pub const DEPTH_ORIGIN: i32 = 1 << 29;

/// Sub-pixel bits of screen coordinates for views of `size` pixels: 15 less the bits that count the pixels.
#[inline(always)]
pub fn subpixel_bits(size: u32) -> u32 {
    15 - size.next_power_of_two().trailing_zeros()
}

/// A quantised orthographic view of the whole lattice, for one image size. `right`, `down` and `forward` are
/// right-handed.
///
/// A point p has the screen coordinates x = (right·p + size·2^(s+14) + 2¹⁴) >> 15, in units of 2⁻ˢ pixels from the left edge
/// of the image (s = [`subpixel_bits`]), y likewise from the top edge with `down`, and the depth forward·p +
/// [`DEPTH_ORIGIN`].
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct View {
    /// Unit vector along the rows, times 2¹⁴·size/P, P the power of two not below the size; then 0.
    pub right: [i32; 4],
    /// Unit vector along the columns, scaled likewise; then 0.
    pub down: [i32; 4],
    /// Unit vector away from the viewer, times 2¹⁴; then 0.
    pub forward: [i32; 4],
}

impl View {
    /// The view along `direction` (any length but 0), of `size` by `size` pixels.
    ///
    /// The opposite direction has the same rows with `right` and `forward` negated: a mirror image of the same lines.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for a direction that is 0 or not finite or a size of 0, [`Error::LimitExceeded`] for a size
    /// beyond [`MAX_SIZE`].
    pub fn along(direction: DVec3, size: u32) -> Result<Self> {
        check_size(size)?;
        let Some(forward) = direction.try_normalize() else {
            return Err(Error::invalid("view", format!("{direction} is no direction")));
        };
        // The least component of the direction, the first of equals: far from parallel, and the same for -direction.
        let a = forward.abs();
        let axis = if a.x <= a.y && a.x <= a.z {
            DVec3::X
        } else if a.y <= a.z {
            DVec3::Y
        } else {
            DVec3::Z
        };
        let right = forward.cross(axis).normalize();
        let down = forward.cross(right);
        let scale = 16_384.0 * f64::from(size) / f64::from(size.next_power_of_two());
        Ok(Self {
            right: quantised(right, scale),
            down: quantised(down, scale),
            forward: quantised(forward, 16_384.0),
        })
    }

    /// The view direction as quantised: unit length to 2⁻¹⁴.
    pub fn direction(&self) -> DVec3 {
        let [x, y, z, _] = self.forward.map(f64::from);
        DVec3::new(x, y, z) / 16_384.0
    }

    /// Whether every product with a position within [`super::REACH`] keeps to the budget.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] with the row that is too long for views of `size` pixels.
    pub fn check(&self, size: u32) -> Result<()> {
        check_size(size)?;
        let scale = 16_384.0 * f64::from(size) / f64::from(size.next_power_of_two());
        for (name, row, length) in
            [("right", self.right, scale), ("down", self.down, scale), ("forward", self.forward, 16_384.0)]
        {
            let squared: i64 =
                row.iter().map(|&c| i64::from(c).saturating_mul(c.into())).fold(0, i64::saturating_add);
            let most = length + 0.75_f64.sqrt();
            if squared as f64 > most * most || row[3] != 0 {
                let what = format!("{row:?} is longer than {length} or has a fourth component");
                return Err(Error::invalid(format!("view.{name}"), what));
            }
        }
        Ok(())
    }
}

pub(crate) fn check_size(size: u32) -> Result<()> {
    if size == 0 {
        return Err(Error::invalid("size", "0 pixels; at least one is needed"));
    }
    if size > MAX_SIZE {
        return Err(Error::limit("pixels per row of a view", size.into(), MAX_SIZE.into()));
    }
    Ok(())
}

fn quantised(row: DVec3, scale: f64) -> [i32; 4] {
    let [x, y, z] = row.to_array().map(|c| (c * scale).round_ties_even() as i32);
    [x, y, z, 0]
}
