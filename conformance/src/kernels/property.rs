//! Properties over generated inputs, with seeds that do not change from run to run.

use crate::trial::{Check, Context, Effort, Failure};
use proptest::strategy::Strategy;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestError, TestRng, TestRunner};

/// Marks a skip on its way through proptest, which only knows failures.
const SKIP: &str = "\u{0}skip";

/// Checks `law` on inputs drawn from `strategy` and reports the smallest input that breaks it, or the first where that will do.
///
/// # Errors
/// That of `law` on that input.
pub(super) fn hold<S: Strategy, B>(
    cx: &Context<'_, B>,
    strategy: S,
    law: impl Fn(S::Value) -> Check,
) -> Check {
    let cases = if cx.options.effort == Effort::Full { 48 } else { 12 };
    // Evidence belongs into the report, not into files beside the sources of whoever calls the suite.
    let max_shrink_iters = if cx.options.first_evidence { 0 } else { 200 };
    let config = Config { cases, failure_persistence: None, max_shrink_iters, ..Config::default() };
    let mut seed = [0_u8; 32];
    seed[..8].copy_from_slice(&cx.options.seed.to_le_bytes());
    // Each trial draws its own inputs, whatever runs before it.
    for (at, byte) in cx.name.bytes().enumerate() {
        seed[8 + at % 24] = seed[8 + at % 24].wrapping_mul(31).wrapping_add(byte);
    }
    let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &seed));
    let outcome = runner.run(&strategy, |input| match law(input) {
        Ok(()) => Ok(()),
        Err(Failure::Skip(reason)) => Err(TestCaseError::fail(format!("{SKIP}{reason}"))),
        Err(Failure::Mismatch(text)) => Err(TestCaseError::fail(text)),
    });
    match outcome {
        Ok(()) => Ok(()),
        Err(TestError::Abort(reason)) => Err(Failure::Mismatch(format!("no inputs: {reason}"))),
        Err(TestError::Fail(reason, input)) => match reason.message().strip_prefix(SKIP) {
            Some(why) => Err(Failure::Skip(why.to_owned())),
            None => {
                Err(Failure::Mismatch(format!("{}\n  smallest input: {}", reason.message(), short(&input))))
            }
        },
    }
}

fn short(input: &impl std::fmt::Debug) -> String {
    let text = format!("{input:?}");
    match text.char_indices().nth(400) {
        Some((end, _)) => format!("{}… ({} characters)", &text[..end], text.len()),
        None => text,
    }
}
