// kernel family: scan
// contract core/src/kernels/scan.rs
// cpu backend-cpu/src/kernels/scan.rs
// gpu backend-gpu/src/kernels/scan.wgsl
// oracle conformance/src/oracle/scan.rs
//! Cases and laws of `scan`. Everything is compared exactly: sums modulo 2³² have one right answer.

use super::property::hold;
use crate::compare::{Shape, exact};
use crate::oracle;
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use proptest::collection::vec;
use proptest::prelude::any;
use twinlight_core::{Backend, Error};
use twinlight_fixtures::random::Random;

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "scan":
        edge_ladder, random_counts, sums_wrap, concatenation, added_constant, repeated, input_is_kept,
        lengths_must_agree, d4_more_groups_than_a_dimension,
    );
}

/// Lengths around every chunk or workgroup size a backend is likely to use.
fn ladder(full: bool) -> Vec<usize> {
    let mut lengths = vec![0, 1, 2, 3];
    let top = if full { 22 } else { 17 };
    for power in [5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 16, 17, 18, 20, 22] {
        if power <= top {
            lengths.extend([(1 << power) - 1, 1 << power, (1 << power) + 1]);
        }
    }
    lengths
}

fn counts(seed: u64, len: usize, bound: u32) -> Vec<u32> {
    let mut random = Random::new(seed);
    (0..len).map(|_| random.index(bound as usize) as u32).collect()
}

/// Scans on the backend. The output starts as all ones: a kernel that writes nothing must not pass for zeros.
fn scanned<B: Backend>(cx: &Context<'_, B>, input: &[u32]) -> Result<(Vec<u32>, u32), Failure> {
    let device_input = cx.backend.upload(input)?;
    let mut output = cx.backend.upload(&vec![u32::MAX; input.len()])?;
    let total = cx.backend.scan(&device_input, &mut output)?;
    Ok((cx.backend.download(&output)?, total))
}

fn agrees<B: Backend>(cx: &Context<'_, B>, input: &[u32]) -> Check {
    let (offsets, total) = scanned(cx, input)?;
    let (want, want_total) = oracle::scan::scan(input);
    let place = format!("{} elements", input.len());
    exact(cx, "offsets", &offsets, &want, Shape::Line).map_err(|f| f.within(&place))?;
    ensure(total == want_total, || format!("{place}: total {total}, want {want_total}"))
}

fn edge_ladder<B: Backend>(cx: &Context<'_, B>) -> Check {
    for len in ladder(cx.full()) {
        agrees(cx, &counts(len as u64 ^ cx.options.seed, len, 1000))?;
    }
    Ok(())
}

fn random_counts<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, vec(any::<u32>(), 0..20_000_usize), |input| agrees(cx, &input))
}

fn sums_wrap<B: Backend>(cx: &Context<'_, B>) -> Check {
    agrees(cx, &[u32::MAX; 3])?;
    agrees(cx, &[1 << 31; 4])?;
    agrees(cx, &vec![u32::MAX; 70_001])
}

/// scan(a ++ b) = scan(a) ++ (total(a) + scan(b)), cut where no chunk ends.
fn concatenation<B: Backend>(cx: &Context<'_, B>) -> Check {
    let input = counts(cx.options.seed ^ 7, 50_021, u32::MAX);
    let (whole, total) = scanned(cx, &input)?;
    for cut in [0, 1, 4097, 33_333, input.len()] {
        let (mut offsets, total_a) = scanned(cx, &input[..cut])?;
        let (second, total_b) = scanned(cx, &input[cut..])?;
        offsets.extend(second.iter().map(|s| s.wrapping_add(total_a)));
        exact(cx, "joined offsets", &offsets, &whole, Shape::Line)?;
        let joined = total_a.wrapping_add(total_b);
        ensure(joined == total, || format!("totals of the parts give {joined}, the whole gives {total}"))?;
    }
    Ok(())
}

/// Adding c to every element adds c·i to offset i.
fn added_constant<B: Backend>(cx: &Context<'_, B>) -> Check {
    let input = counts(cx.options.seed ^ 11, 9_999, u32::MAX);
    let shifted: Vec<u32> = input.iter().map(|x| x.wrapping_add(77)).collect();
    let want: Vec<u32> =
        (0_u32..).zip(&scanned(cx, &input)?.0).map(|(i, s)| s.wrapping_add(i.wrapping_mul(77))).collect();
    exact(cx, "offsets", &scanned(cx, &shifted)?.0, &want, Shape::Line)
}

fn repeated<B: Backend>(cx: &Context<'_, B>) -> Check {
    let input = counts(cx.options.seed ^ 13, 100_003, u32::MAX);
    let (first, total) = scanned(cx, &input)?;
    for _ in 0..3 {
        let (again, total_again) = scanned(cx, &input)?;
        exact(cx, "offsets of a second run", &again, &first, Shape::Line)?;
        ensure(total == total_again, || format!("total {total}, then {total_again}"))?;
    }
    Ok(())
}

fn input_is_kept<B: Backend>(cx: &Context<'_, B>) -> Check {
    let input = counts(cx.options.seed ^ 17, 5_000, u32::MAX);
    let device_input = cx.backend.upload(&input)?;
    let mut output = cx.backend.zeroed::<u32>(input.len())?;
    cx.backend.scan(&device_input, &mut output)?;
    exact(cx, "input after the scan", &cx.backend.download(&device_input)?, &input, Shape::Line)
}

fn lengths_must_agree<B: Backend>(cx: &Context<'_, B>) -> Check {
    let input = cx.backend.upload(&[1_u32, 2, 3])?;
    for len in [0, 2, 4] {
        let mut output = cx.backend.upload(&vec![9_u32; len])?;
        match cx.backend.scan(&input, &mut output) {
            Err(Error::InvalidInput { .. }) => {}
            Err(Error::Unsupported(what)) => return Err(Failure::Skip(what)),
            other => {
                return Err(Failure::Mismatch(format!(
                    "3 counts, {len} offsets: {other:?}, want InvalidInput"
                )));
            }
        }
        exact(cx, "output of a refused call", &cx.backend.download(&output)?, &vec![9; len], Shape::Line)?;
    }
    Ok(())
}

/// 65535 groups of 256 are 16 776 960 elements: beyond that a dispatch needs a second dimension.
fn d4_more_groups_than_a_dimension<B: Backend>(cx: &Context<'_, B>) -> Check {
    if !cx.full() {
        return agrees(cx, &counts(cx.options.seed ^ 19, 300_001, 10));
    }
    agrees(cx, &counts(cx.options.seed ^ 19, 65_535 * 256 + 257, 10))
}
