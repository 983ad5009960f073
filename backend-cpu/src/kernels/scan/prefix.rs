//! Sum and exclusive prefix sum of one chunk on one thread.

/// Sum modulo 2³². Compiles to vector additions on every target.
pub(super) fn sum(chunk: &[u32]) -> u32 {
    chunk.iter().fold(0, |sum: u32, &x| sum.wrapping_add(x))
}

/// Writes `offset` plus the exclusive prefix sums of `input` to `output` (of the same length); returns `offset` plus
/// the sum. With `stream`, past the caches where the target can.
pub(super) fn prefix(input: &[u32], output: &mut [u32], offset: u32, stream: bool) -> u32 {
    #[cfg(target_arch = "x86_64")]
    if stream {
        x86::prefix::<true>(input, output, offset)
    } else {
        x86::prefix::<false>(input, output, offset)
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        // Without streaming stores there is one way to write.
        let _ = stream;
        scalar(input, output, offset)
    }
}

fn scalar(input: &[u32], output: &mut [u32], offset: u32) -> u32 {
    input.iter().zip(output).fold(offset, |sum, (&x, out)| {
        *out = sum;
        sum.wrapping_add(x)
    })
}

/// Four at a time with SSE2, which every x86-64 has. Wider registers gain nothing: the loop already outruns memory.
#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::*;

    const LANES: usize = 4;

    pub(super) fn prefix<const STREAM: bool>(input: &[u32], output: &mut [u32], offset: u32) -> u32 {
        let len = input.len().min(output.len());
        let (input, output) = (&input[..len], &mut output[..len]);
        // Streaming stores need aligned addresses.
        let head = output.as_ptr().align_offset(align_of::<__m128i>()).min(len);
        let body = (len - head) / LANES * LANES;
        let mut sum = super::scalar(&input[..head], &mut output[..head], offset);
        // SAFETY: SSE2 is part of x86-64. `head + body <= len`, so every access is inside the slices; `output` is
        // 16-byte aligned at `head`, and its pointer comes from a unique borrow. The fence orders the streaming stores
        // before whatever makes another thread read them.
        unsafe {
            let from = input.as_ptr().add(head);
            let to = output.as_mut_ptr().add(head);
            let mut carry = _mm_set1_epi32(sum as i32);
            for i in (0..body).step_by(LANES) {
                let x = _mm_loadu_si128(from.add(i).cast());
                let pairs = _mm_add_epi32(x, _mm_slli_si128::<4>(x));
                let inclusive = _mm_add_epi32(pairs, _mm_slli_si128::<8>(pairs));
                let exclusive = _mm_add_epi32(carry, _mm_slli_si128::<4>(inclusive));
                if STREAM {
                    _mm_stream_si128(to.add(i).cast(), exclusive);
                } else {
                    _mm_store_si128(to.add(i).cast(), exclusive);
                }
                // Only this addition waits for the step before.
                carry = _mm_add_epi32(carry, _mm_shuffle_epi32::<0xFF>(inclusive));
            }
            if STREAM {
                _mm_sfence();
            }
            sum = _mm_cvtsi128_si32(carry) as u32;
        }
        super::scalar(&input[head + body..], &mut output[head + body..], sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_length_and_alignment_gives_the_scalar_sums() {
        let input: Vec<u32> = (0..100_u32).map(|i| i.wrapping_mul(0x9E37_79B9) | 1 << 31).collect();
        for start in 0..8 {
            for len in 0..40 {
                for stream in [false, true] {
                    let (mut out, mut expected) = (vec![7; 100], vec![7; 100]);
                    let chunk = &input[3..3 + len];
                    let total = prefix(chunk, &mut out[start..start + len], 5, stream);
                    assert_eq!(total, scalar(chunk, &mut expected[start..start + len], 5));
                    assert_eq!(out, expected, "start {start}, length {len}");
                    assert_eq!(total, sum(chunk).wrapping_add(5));
                }
            }
        }
    }
}
