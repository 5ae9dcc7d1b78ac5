//! Small scenes, one for each effect, put together from parts: what a plan must find in them is known.

/// Parts of a scene; [`Small::text`] writes it down.
#[derive(Debug, Clone)]
pub struct Small {
    /// 1, 2 or 3.
    pub dimension: usize,
    /// Expression of the diffusivity inside of the ball (`None`: one region).
    pub inside: Option<&'static str>,
    /// Expression of the diffusivity outside.
    pub outside: &'static str,
    /// Expression of the source.
    pub source: Option<&'static str>,
    /// Extra tables.
    pub extra: &'static str,
    /// Boundary tables.
    pub boundaries: &'static str,
    /// Spacing.
    pub spacing: &'static str,
    /// Layout.
    pub layout: &'static str,
}

impl Default for Small {
    fn default() -> Self {
        Self {
            dimension: 2,
            inside: None,
            outside: "1",
            source: None,
            extra: "",
            boundaries: "[[boundaries]]\nface = \"all\"\ndirichlet = \"x\"\n",
            spacing: "0.1",
            layout: "irregular",
        }
    }
}

impl Small {
    /// The scene: the unit box, with a ball of radius 0.3 in its middle if there is something inside.
    pub fn text(&self) -> String {
        let row = |value: &str| vec![value; self.dimension].join(", ");
        let mut text = format!(
            "title = \"small\"\ndimension = {}\n\n[domain]\nbox = {{ min = [{}], max = [{}] }}\n\n\
             [points]\nspacing = {}\nlayout = \"{}\"\nseed = 3\n\n",
            self.dimension,
            row("0.0"),
            row("1.0"),
            if self.spacing.parse::<f64>().is_ok() {
                self.spacing.to_owned()
            } else {
                format!("\"{}\"", self.spacing)
            },
            self.layout,
        );
        let source = self.source.map_or(String::new(), |s| format!("source = \"{s}\"\n"));
        if let Some(inside) = self.inside {
            text += &format!(
                "[[regions]]\nname = \"inside\"\nsphere = {{ center = [{}], radius = 0.3 }}\n\
                 diffusivity = \"{inside}\"\n{source}\n",
                row("0.5")
            );
        }
        text + &format!("[[regions]]\nname = \"outside\"\ndiffusivity = \"{}\"\n{source}\n", self.outside)
            + self.extra
            + self.boundaries
    }
}
