// kernel family: sort
// contract core/src/kernels/sort.rs
// cpu backend-cpu/src/kernels/sort.rs
// gpu backend-gpu/src/kernels/sort.wgsl
// oracle conformance/src/oracle/sort.rs
//! Cases and laws of `sort`. Everything is compared exactly: a stable sort of integers has one right answer.

use super::property::hold;
use crate::compare::{Record, Shape, exact};
use crate::oracle;
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use proptest::collection::vec;
use proptest::prelude::any;
use twinlight_core::{Backend, Error, Result};
use twinlight_fixtures::random::Random;

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "sort":
        edge_ladder_u32, edge_ladder_u64, random_keys_u32, random_keys_u64, few_distinct_keys_are_stable,
        every_digit_decides, presorted_and_reversed, extremes, sorted_again, shuffled_input, wide_keys_like_narrow,
        repeated_keys, lengths_must_agree, many_pairs,
    );
}

/// A key type of the contract.
trait Key: Record + Ord {
    fn run<B: Backend>(backend: &B, keys: &mut B::Buffer<Self>, payload: &mut B::Buffer<u32>) -> Result<()>;
    fn draw(random: &mut Random) -> Self;
}

impl Key for u32 {
    fn run<B: Backend>(backend: &B, keys: &mut B::Buffer<u32>, payload: &mut B::Buffer<u32>) -> Result<()> {
        backend.sort_u32(keys, payload)
    }

    fn draw(random: &mut Random) -> u32 {
        random.next_u32()
    }
}

impl Key for u64 {
    fn run<B: Backend>(backend: &B, keys: &mut B::Buffer<u64>, payload: &mut B::Buffer<u32>) -> Result<()> {
        backend.sort_u64(keys, payload)
    }

    fn draw(random: &mut Random) -> u64 {
        random.next_u64()
    }
}

fn sorted<K: Key, B: Backend>(
    cx: &Context<'_, B>,
    keys: &[K],
    payload: &[u32],
) -> std::result::Result<(Vec<K>, Vec<u32>), Failure> {
    let mut device_keys = cx.backend.upload(keys)?;
    let mut device_payload = cx.backend.upload(payload)?;
    K::run(cx.backend, &mut device_keys, &mut device_payload)?;
    Ok((cx.backend.download(&device_keys)?, cx.backend.download(&device_payload)?))
}

/// Sorts with the input position as payload, so that a lost or unstable pair shows.
fn agrees<K: Key, B: Backend>(cx: &Context<'_, B>, keys: &[K]) -> Check {
    let payload: Vec<u32> = (0..keys.len() as u32).collect();
    let (got_keys, got_payload) = sorted(cx, keys, &payload)?;
    let (want_keys, want_payload) = oracle::sort::sort(keys, &payload);
    let place = format!("{} keys", keys.len());
    exact(cx, "keys", &got_keys, &want_keys, Shape::Line).map_err(|f| f.within(&place))?;
    exact(cx, "payload", &got_payload, &want_payload, Shape::Line).map_err(|f| f.within(&place))
}

fn ladder<K: Key, B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut lengths = vec![0, 1, 2, 3, 31, 33];
    for power in [8, 9, 10, 11, 12, 13, 14, 16, 18, 20] {
        if power <= if cx.full() { 20 } else { 14 } {
            lengths.extend([(1 << power) - 1, 1 << power, (1 << power) + 1]);
        }
    }
    for len in lengths {
        let mut random = Random::new(len as u64 ^ cx.options.seed);
        agrees(cx, &(0..len).map(|_| K::draw(&mut random)).collect::<Vec<_>>())?;
    }
    Ok(())
}

fn edge_ladder_u32<B: Backend>(cx: &Context<'_, B>) -> Check {
    ladder::<u32, B>(cx)
}

fn edge_ladder_u64<B: Backend>(cx: &Context<'_, B>) -> Check {
    ladder::<u64, B>(cx)
}

fn random_keys_u32<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, vec(any::<u32>(), 0..6_000_usize), |keys| agrees(cx, &keys))
}

fn random_keys_u64<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, vec(any::<u64>(), 0..6_000_usize), |keys| agrees(cx, &keys))
}

fn few_distinct_keys_are_stable<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 23);
    for distinct in [1, 2, 3, 17] {
        let draws: Vec<u32> = (0..20_011).map(|_| random.index(distinct) as u32).collect();
        agrees(cx, &draws.iter().map(|d| d.wrapping_mul(0x1234_5679)).collect::<Vec<u32>>())?;
        agrees(cx, &draws.iter().map(|&d| u64::from(d) << 33 | u64::from(d)).collect::<Vec<u64>>())?;
    }
    Ok(())
}

/// Keys that differ in one group of four bits only: a skipped pass leaves them as they came.
fn every_digit_decides<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 29);
    for shift in (0..64).step_by(4) {
        let digits: Vec<u64> = (0..1_500).map(|_| random.next_u64() & 15).collect();
        agrees(cx, &digits.iter().map(|d| d << shift).collect::<Vec<u64>>())?;
        if shift < 32 {
            agrees(cx, &digits.iter().map(|&d| (d << shift) as u32).collect::<Vec<u32>>())?;
        }
    }
    Ok(())
}

fn presorted_and_reversed<B: Backend>(cx: &Context<'_, B>) -> Check {
    let rising: Vec<u32> = (0..40_000).map(|i| i / 3 * 7919).collect();
    let falling: Vec<u32> = rising.iter().rev().copied().collect();
    agrees(cx, &rising)?;
    agrees(cx, &falling)?;
    agrees(cx, &falling.iter().map(|&k| u64::from(k) << 31).collect::<Vec<u64>>())
}

fn extremes<B: Backend>(cx: &Context<'_, B>) -> Check {
    let narrow = [u32::MAX, 0, 1 << 31, u32::MAX, (1 << 31) - 1, 0, 1];
    let wide = [u64::MAX, 0, 1 << 63, u64::MAX, (1 << 63) - 1, 1 << 32, (1 << 32) - 1, 0];
    agrees(cx, &narrow.repeat(300))?;
    agrees(cx, &wide.repeat(300))?;
    // Padding that a backend adds to fill its last block must not leak into the result.
    agrees(cx, &[u32::MAX; 1000])?;
    agrees(cx, &[u64::MAX; 1000])
}

/// Sorting what is sorted changes nothing.
fn sorted_again<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 31);
    let keys: Vec<u32> = (0..10_007).map(|_| random.index(5_000) as u32).collect();
    let (keys, payload) = sorted(cx, &keys, &(0..10_007).collect::<Vec<u32>>())?;
    let (keys_again, payload_again) = sorted(cx, &keys, &payload)?;
    exact(cx, "keys", &keys_again, &keys, Shape::Line)?;
    exact(cx, "payload", &payload_again, &payload, Shape::Line)
}

/// Distinct keys: the input's order must not show.
fn shuffled_input<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 37);
    let keys: Vec<u32> = (0..8_191_u32).map(|i| i.wrapping_mul(0x9e37_79b1)).collect();
    let mut order: Vec<usize> = (0..keys.len()).collect();
    for i in (1..order.len()).rev() {
        order.swap(i, random.index(i + 1));
    }
    let shuffled: Vec<u32> = order.iter().map(|&i| keys[i]).collect();
    let straight = sorted(cx, &keys, &(0..8_191).collect::<Vec<u32>>())?;
    let turned = sorted(cx, &shuffled, &order.iter().map(|&i| i as u32).collect::<Vec<u32>>())?;
    exact(cx, "keys", &turned.0, &straight.0, Shape::Line)?;
    exact(cx, "payload", &turned.1, &straight.1, Shape::Line)
}

/// u64 keys below 2³² sort as u32 keys do.
fn wide_keys_like_narrow<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 41);
    let narrow: Vec<u32> = (0..5_003).map(|_| random.index(3_000) as u32).collect();
    let wide: Vec<u64> = narrow.iter().map(|&k| u64::from(k)).collect();
    let payload: Vec<u32> = (0..5_003).collect();
    let (_, of_narrow) = sorted(cx, &narrow, &payload)?;
    let (_, of_wide) = sorted(cx, &wide, &payload)?;
    exact(cx, "payload", &of_wide, &of_narrow, Shape::Line)
}

fn repeated_keys<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 43);
    let keys: Vec<u64> = (0..30_011).map(|_| random.next_u64() & 0xff00_00ff_0000).collect();
    let payload: Vec<u32> = (0..30_011).collect();
    let first = sorted(cx, &keys, &payload)?;
    for _ in 0..3 {
        let again = sorted(cx, &keys, &payload)?;
        exact(cx, "payload of a second run", &again.1, &first.1, Shape::Line)?;
    }
    Ok(())
}

fn lengths_must_agree<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut payload = cx.backend.upload(&[1_u32, 2, 3])?;
    let mut narrow = cx.backend.upload(&[4_u32, 3])?;
    let mut wide = cx.backend.upload(&[4_u64, 3, 2, 1])?;
    for refused in
        [cx.backend.sort_u32(&mut narrow, &mut payload), cx.backend.sort_u64(&mut wide, &mut payload)]
    {
        match refused {
            Err(Error::InvalidInput { .. }) => {}
            Err(Error::Unsupported(what)) => return Err(Failure::Skip(what)),
            other => return Err(Failure::Mismatch(format!("unequal lengths: {other:?}, want InvalidInput"))),
        }
    }
    let kept = cx.backend.download(&payload)?;
    ensure(kept == [1, 2, 3], || format!("a refused call changed the payload to {kept:?}"))
}

fn many_pairs<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 47);
    let len = if cx.full() { 3_000_017 } else { 120_011 };
    agrees(cx, &(0..len).map(|_| random.next_u32()).collect::<Vec<u32>>())
}
