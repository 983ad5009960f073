use super::*;
use twinlight_core::kernels::rasterize_lhb::CAP_FAR;

#[test]
fn words_have_their_bits_where_the_document_has_them() {
    let element = LhbElement { surface: 2 * 0xabcde + 1, depth: (0x2a5 << 19) + 77 };
    let word = word_of(element);
    assert_eq!(word, 0x2a5 << 21 | 0xabcde << 1 | 1);
    assert_eq!(element_of(word), LhbElement { depth: (0x2a5 << 19) + (1 << 18), ..element });
    assert_eq!(word_of(LhbElement { surface: 0, depth: u32::MAX }), 2047 << 21);
}

#[test]
fn layers_keep_either_end_and_count_the_rest() {
    let list = |depths: &[u32]| -> Vec<LhbElement> {
        depths.iter().map(|&bin| LhbElement { surface: bin, depth: bin << 19 }).collect()
    };
    let pixels = [list(&[1, 2, 3]), list(&[]), list(&[4])];
    let lists = Lists { left_out: vec![5, 0, u32::MAX], ..Lists::of(pixels.iter().map(Vec::as_slice)) };
    let near = pack(&lists, &PackLhbParams { layers: 2, cap_side: CAP_NEAR });
    let word = |bin: u32| bin << 21 | bin;
    assert_eq!(near.words, [word(1), word(2), EMPTY, EMPTY, word(4), EMPTY]);
    assert_eq!((near.offsets.len(), near.left_out.as_slice()), (0, [6, 0, u32::MAX].as_slice()));
    let far = pack(&lists, &PackLhbParams { layers: 2, cap_side: CAP_FAR });
    assert_eq!(far.words[..2], [word(2), word(3)]);
    let back = unpack(&far, 2);
    assert_eq!((back.offsets.as_slice(), back.elements.len()), ([0, 2, 2, 3].as_slice(), 3));
    assert_eq!(back.elements[2], LhbElement { surface: 4, depth: (4 << 19) + (1 << 18) });
}
