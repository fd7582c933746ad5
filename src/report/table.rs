//! The numbers behind a figure, as CSV.

use super::error::ReportError;

/// A table whose header names each column with its unit, as in `radius_m`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Column names.
    pub header: Vec<String>,
    /// Rows of cells, each as long as the header.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// An empty table with the given columns.
    pub fn new(header: &[&str]) -> Table {
        Table {
            header: header.iter().map(|name| name.to_string()).collect(),
            rows: Vec::new(),
        }
    }

    /// The table as CSV text.
    pub fn to_csv(&self) -> Result<String, ReportError> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(&self.header)?;
        for row in &self.rows {
            writer.write_record(row)?;
        }
        let bytes = writer
            .into_inner()
            .map_err(|error| csv::Error::from(error.into_error()))?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }
}

/// A number as a cell: all its digits, or nothing if it is not finite.
pub(super) fn cell(value: f64) -> String {
    if value.is_finite() {
        // Adding zero turns −0 into 0.
        format!("{}", value + 0.0)
    } else {
        String::new()
    }
}

/// The name of a column with its unit: ("size", "m^2 rad") → "size_m2_rad".
pub(super) fn column(name: &str, unit: &str) -> String {
    match unit.replace('^', "").replace(' ', "_") {
        unit if unit.is_empty() => name.to_string(),
        unit => format!("{name}_{unit}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn header_rows_and_quotes() {
        let mut table = Table::new(&["joint", "upper_deg"]);
        table.rows.push(vec!["a, \"b\"".into(), cell(-0.0)]);
        table.rows.push(vec!["2".into(), cell(f64::NAN)]);
        let text = table.to_csv().unwrap();
        assert_eq!(text, "joint,upper_deg\n\"a, \"\"b\"\"\",0\n2,\n");
    }
}
