//! What a study found, as CSV (RFC 4180).

use super::data::Fronts;
use super::page::title;
use super::records::Point;
use twinlight::methods::cost::METRICS;

/// A line per setting; what is no number is empty.
pub fn csv(points: &[&Point]) -> String {
    let fronts = Fronts::of(points);
    let mut head = vec!["id", "method", "settings", "median_s", "least_s", "most_s", "runs", "bytes"];
    head.extend(METRICS.map(|metric| metric.key()));
    head.extend(["front", "method_front"]);
    let mut text = line(head.into_iter().map(str::to_owned));
    for (id, point) in points.iter().enumerate() {
        let times = [point.seconds.median, point.seconds.least, point.seconds.most];
        let mut cells = vec![id.to_string(), point.setting.method.clone(), title(&point.setting)];
        cells.extend(times.map(|seconds| seconds.to_string()));
        cells.extend([point.runs.to_string(), point.bytes.to_string()]);
        cells.extend(point.errors.map(|error| error.map_or_else(String::new, |error| error.to_string())));
        cells.extend([fronts.all(id).join(" "), fronts.own(id).join(" ")]);
        text += &line(cells.into_iter());
    }
    text
}

fn line(cells: impl Iterator<Item = String>) -> String {
    cells.map(|cell| quoted(&cell)).collect::<Vec<_>>().join(",") + "\r\n"
}

fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\r', '\n']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_quoted_where_they_must_be() {
        let cells = ["plain", "a,b", "say \"so\"", "two\nlines", ""];
        assert_eq!(
            line(cells.into_iter().map(str::to_owned)),
            "plain,\"a,b\",\"say \"\"so\"\"\",\"two\nlines\",\r\n"
        );
    }
}
