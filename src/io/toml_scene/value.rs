//! A number for all three axes or channels, or one number for each.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use std::borrow::Cow;
use std::fmt;

/// Three numbers, written as three or as one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct OneOrThree(pub [f64; 3]);

impl OneOrThree {
    pub fn narrow(self) -> [f32; 3] {
        self.0.map(|x| x as f32)
    }
}

// By hand: a derived untagged enum would only say that no variant matched.
impl<'de> Deserialize<'de> for OneOrThree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Numbers;

        impl<'de> Visitor<'de> for Numbers {
            type Value = OneOrThree;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number or three numbers")
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<OneOrThree, E> {
                Ok(OneOrThree([value as f64; 3]))
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<OneOrThree, E> {
                Ok(OneOrThree([value; 3]))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<OneOrThree, A::Error> {
                let mut numbers = [0.0; 3];
                for (i, number) in numbers.iter_mut().enumerate() {
                    *number = sequence.next_element()?.ok_or_else(|| A::Error::invalid_length(i, &self))?;
                }
                match sequence.next_element::<f64>()? {
                    Some(_) => Err(A::Error::invalid_length(4, &self)),
                    None => Ok(OneOrThree(numbers)),
                }
            }
        }

        deserializer.deserialize_any(Numbers)
    }
}

impl JsonSchema for OneOrThree {
    fn schema_name() -> Cow<'static, str> {
        "OneOrThree".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "Three numbers, or one for all three.",
            "anyOf": [
                { "type": "number" },
                { "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 }
            ]
        })
    }
}
