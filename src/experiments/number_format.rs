//! Numbers in text formats: JSON has no NaN and no infinity, so NaN is written as `null` and
//! infinity as a string. Binary formats keep all numbers as they are.

use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{self, Visitor},
};

/// A number that text formats can represent.
#[derive(Clone, Copy)]
struct Number(f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.0.is_finite() || !serializer.is_human_readable() {
            serializer.serialize_f64(self.0)
        } else if self.0.is_nan() {
            serializer.serialize_unit()
        } else {
            serializer.serialize_str(if 0.0 < self.0 { "inf" } else { "-inf" })
        }
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            deserializer.deserialize_any(Text)
        } else {
            f64::deserialize(deserializer).map(Self)
        }
    }
}

struct Text;

impl Visitor<'_> for Text {
    type Value = Number;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("a number, null, \"inf\" or \"-inf\"")
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Number, E> {
        Ok(Number(value))
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Number, E> {
        Ok(Number(value as f64))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Number, E> {
        Ok(Number(value as f64))
    }

    fn visit_unit<E: de::Error>(self) -> Result<Number, E> {
        Ok(Number(f64::NAN))
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Number, E> {
        match text {
            "inf" => Ok(Number(f64::INFINITY)),
            "-inf" => Ok(Number(f64::NEG_INFINITY)),
            _ => Err(E::invalid_value(de::Unexpected::Str(text), &self)),
        }
    }
}

/// For `#[serde(with = …)]` on one number.
pub(super) mod one {
    use super::*;

    pub(crate) fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        Number(*value).serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        Number::deserialize(deserializer).map(|it| it.0)
    }
}

/// For `#[serde(with = …)]` on a list of numbers.
pub(super) mod many {
    use super::*;

    pub(crate) fn serialize<S: Serializer>(
        values: &[f64],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(values.iter().copied().map(Number))
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<f64>, D::Error> {
        let numbers = Vec::<Number>::deserialize(deserializer)?;
        Ok(numbers.into_iter().map(|it| it.0).collect())
    }
}

/// For `#[serde(with = …)]` on a list of points.
pub(super) mod points {
    use super::*;

    pub(crate) fn serialize<S: Serializer>(
        points: &[[f64; 2]],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(points.iter().map(|point| point.map(Number)))
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<[f64; 2]>, D::Error> {
        let points = Vec::<[Number; 2]>::deserialize(deserializer)?;
        Ok(points.into_iter().map(|point| point.map(|it| it.0)).collect())
    }
}

#[cfg(test)]
mod tests {
    use crate::experiments::record::Column;

    /// Oracle: the bits before they were written.
    #[test]
    fn every_number_survives_json_and_postcard() {
        let values = vec![0.1, -0.0, 3.0, 1e300, f64::MIN_POSITIVE, f64::INFINITY, -f64::INFINITY];
        let mut column = Column { name: "x".to_owned(), unit: "1".to_owned(), values };
        column.values.push(f64::NAN);
        let bits = |it: &Column| it.values.iter().map(|it| it.to_bits()).collect::<Vec<_>>();
        let json = serde_json::to_string(&column).unwrap();
        assert!(json.ends_with("\"inf\",\"-inf\",null]}"), "{json}");
        let again: Column = serde_json::from_str(&json).unwrap();
        assert_eq!(bits(&again), bits(&column));
        let bytes = postcard::to_stdvec(&column).unwrap();
        let again: Column = postcard::from_bytes(&bytes).unwrap();
        assert_eq!(bits(&again), bits(&column));
        let wrong = serde_json::from_str::<Column>(r#"{"name":"x","unit":"1","values":["many"]}"#);
        assert!(wrong.unwrap_err().to_string().contains("many"));
    }
}
