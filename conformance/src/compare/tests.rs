use super::*;
use crate::trial::Options;
use twinlight_core::kernels::filter_indirect::RadianceTexel;
use twinlight_core::kernels::rasterize_lhb::LhbElement;
use twinlight_core::kernels::shade_primary::GBufferTexel;
use twinlight_core::kernels::trace::Hit;
use twinlight_core::kernels::trace_paths::FilmTexel;

fn text(check: Check) -> String {
    match check {
        Err(Failure::Mismatch(text)) => text,
        other => panic!("expected a mismatch, got {other:?}"),
    }
}

fn context(options: &Options) -> Context<'_, ()> {
    Context { backend: &(), options, name: "kernel.trial" }
}

#[test]
fn fields_cover_their_records() {
    fn bytes<T: Record>() -> (usize, usize) {
        (
            T::FIELDS.iter().map(|f| f.count * if f.kind == Kind::Unsigned64 { 8 } else { 4 }).sum(),
            size_of::<T>(),
        )
    }
    for (fields, record) in [
        bytes::<u32>(),
        bytes::<u64>(),
        bytes::<Hit>(),
        bytes::<GBufferTexel>(),
        bytes::<FilmTexel>(),
        bytes::<LhbElement>(),
        bytes::<RadianceTexel>(),
    ] {
        assert_eq!(fields, record);
    }
}

#[test]
fn equal_arrays_pass_and_one_bit_fails_with_evidence() {
    let options = Options::default();
    let a = [Hit { t: 1.0, triangle: 3, u: 0.0, v: 0.5 }; 7];
    let mut b = a;
    assert_eq!(exact(&context(&options), "hits", &a, &b, Shape::Line), Ok(()));
    b[4].t = f32::from_bits(1.0_f32.to_bits() + 1);
    let text = text(exact(&context(&options), "hits", &a, &b, Shape::Image { width: 3 }));
    for part in ["1 of 7", "[4] (x 1, y 1) t", "0x3f800000", "0x3f800001", "1 ulp apart"] {
        assert!(text.contains(part), "{part:?} is missing in {text}");
    }
}

#[test]
fn negative_zero_is_not_zero_to_the_exact_comparison() {
    let options = Options::default();
    let at = |t| [Hit { t, triangle: 0, u: 0.0, v: 0.0 }];
    assert!(exact(&context(&options), "hits", &at(0.0), &at(-0.0), Shape::Line).is_err());
}

#[test]
fn five_are_shown_and_the_rest_is_counted() {
    let options = Options::default();
    let text = text(exact(&context(&options), "sums", &[1_u32; 9], &[2_u32; 9], Shape::Line));
    assert_eq!(text.matches("off by -1").count(), 5, "{text}");
    assert!(text.contains("9 of 9") && text.contains("4 more"), "{text}");
}

#[test]
fn lengths_are_compared_first() {
    let options = Options::default();
    assert!(exact(&context(&options), "sums", &[1_u32; 2], &[1_u32; 3], Shape::Line).is_err());
}

#[test]
fn intervals_refuse_nan_and_say_what_was_allowed() {
    let mut evidence = Evidence::new("t", Shape::Line);
    evidence.interval(0, "t", 1.0, 1.0, 1.0, "exact");
    evidence.interval(1, "t", f32::NAN, f64::NEG_INFINITY, f64::INFINITY, "anything");
    evidence.interval(2, "t", 2.0, 0.0, 1.5, "three roundings");
    assert_eq!(evidence.wrong(), 2);
    let text = text(evidence.finish());
    assert!(text.contains("NaN") && text.contains("1.5e0 (three roundings)"), "{text}");
}

#[test]
fn dumps_hold_both_buffers() {
    let folder = std::env::temp_dir().join(format!("twinlight-dump-{}", std::process::id()));
    let options = Options { dump_dir: Some(folder.clone()), ..Options::default() };
    let text = text(exact(&context(&options), "sums", &[1_u32, 2], &[1_u32, 3], Shape::Line));
    let got = std::fs::read(folder.join("kernel.trial.sums.got.bin")).unwrap();
    let want = std::fs::read(folder.join("kernel.trial.sums.want.bin")).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    assert_eq!((got, want), (vec![1, 0, 0, 0, 2, 0, 0, 0], vec![1, 0, 0, 0, 3, 0, 0, 0]));
    assert!(text.contains("kernel.trial.sums.got.bin"), "{text}");
}

#[test]
fn ulps_count_across_zero() {
    assert_eq!(ulps(0.0, -0.0), Some(0));
    assert_eq!(ulps(f32::from_bits(1), -f32::from_bits(1)), Some(2));
    assert_eq!(ulps(1.0, f32::NAN), None);
}
