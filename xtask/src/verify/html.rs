//! The report: one page that needs no network.

use std::fmt::Write;

use meshless_output::OutputError;

use super::claims::{Claim, Verdict};
use super::figure::Figure;
use super::study::{Section, Study, Table};
use super::suite;

const STYLE: &str = include_str!("style.css");

/// The page, and the pictures in it by their names.
#[derive(Debug)]
pub(crate) struct Page {
    pub(crate) html: String,
    pub(crate) pictures: Vec<(String, String)>,
}

/// Writing to a string cannot fail; this says so in one place.
macro_rules! put {
    ($page:expr, $($text:tt)*) => {
        let _ = write!($page, $($text)*);
    };
}

pub(crate) fn page(studies: &[Study]) -> Result<Page, OutputError> {
    let mut page = Page { html: String::new(), pictures: Vec::new() };
    put!(page.html, "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    put!(page.html, "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
    put!(
        page.html,
        "<title>Verification of meshless</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n"
    );
    head(&mut page.html, studies);
    for study in studies {
        suite_part(&mut page, study)?;
    }
    put!(page.html, "</main>\n</body>\n</html>\n");
    Ok(page)
}

fn head(html: &mut String, studies: &[Study]) {
    let claims: Vec<&Claim> = studies.iter().flat_map(|s| &s.claims).collect();
    let count = |holds: &str| claims.iter().filter(|c| c.holds() == holds).count();
    let runs: usize = studies.iter().map(|s| s.outcomes.len()).sum();
    put!(
        html,
        "<h1>Verification</h1>\n<p class=\"lead\">Published benchmarks and hard cases, solved as a user would solve them. "
    );
    put!(
        html,
        "Every statement below was checked by the program that wrote this page; nothing was read off a diagram.</p>\n"
    );
    put!(html, "<div class=\"tally\"><div><b>{runs}</b>runs</div><div><b>{}</b>claims</div>", claims.len());
    put!(
        html,
        "<div class=\"good\"><b>{}</b>hold</div><div class=\"note\"><b>{}</b>explained</div>",
        count("yes"),
        count("explained")
    );
    put!(
        html,
        "<div class=\"{}\"><b>{}</b>do not hold</div></div>\n",
        if count("no") > 0 { "bad" } else { "" },
        count("no")
    );
    contents(html, studies);
    put!(
        html,
        "<h2 id=\"claims\">All claims</h2>\n<p>A claim of a paper that we measure otherwise is marked <span class=\"mark explained\">explained</span>: "
    );
    put!(
        html,
        "the line below it says why, and our own figure must stay within the band that is given.</p>\n"
    );
    claims_table(html, &claims, true);
}

fn contents(html: &mut String, studies: &[Study]) {
    put!(html, "<nav><ul>\n<li><a href=\"#claims\">All claims</a></li>\n");
    for study in studies {
        put!(html, "<li><a href=\"#{0}\">Suite {0}</a></li>\n", study.suite);
        for section in &study.sections {
            put!(
                html,
                "<li class=\"case\"><a href=\"#{}-{}\">{}</a></li>\n",
                study.suite,
                section.case,
                escape(section.title)
            );
        }
    }
    put!(html, "</ul></nav>\n");
}

fn suite_part(page: &mut Page, study: &Study) -> Result<(), OutputError> {
    let about = suite::find(study.suite).map_or("", |s| s.about);
    put!(page.html, "<h2 id=\"{0}\">Suite {0}</h2>\n<p>{1}</p>\n", study.suite, escape(about));
    study.sections.iter().try_for_each(|section| case_part(page, study, section))
}

fn case_part(page: &mut Page, study: &Study, section: &Section) -> Result<(), OutputError> {
    put!(page.html, "<h3 id=\"{}-{}\">{}</h3>\n", study.suite, section.case, escape(section.title));
    put!(page.html, "<p>{}</p>\n", escape(section.about));
    put!(page.html, "<div class=\"pair\">\n");
    for picture in &section.pictures {
        show(page, &picture.name, &picture.svg, &picture.caption);
    }
    put!(page.html, "</div>\n");
    for figure in section.figures.iter().filter(|f| f.curves.iter().any(|c| !c.points.is_empty())) {
        show(page, &figure.name, &figure.svg()?, &figure.caption);
        data(&mut page.html, figure);
    }
    section.tables.iter().filter(|t| !t.rows.is_empty()).for_each(|t| table(&mut page.html, t));
    let claims: Vec<&Claim> = study.claims.iter().filter(|c| c.case == section.case).collect();
    if !claims.is_empty() {
        claims_table(&mut page.html, &claims, false);
    }
    Ok(())
}

fn show(page: &mut Page, name: &str, svg: &str, caption: &str) {
    // Identifiers inside of pictures must differ from picture to picture once they share a page.
    let inline = svg
        .replace("id=\"", &format!("id=\"{name}-"))
        .replace("url(#", &format!("url(#{name}-"))
        .replace("href=\"#", &format!("href=\"#{name}-"));
    put!(page.html, "<figure>\n{inline}\n<figcaption>{}</figcaption>\n</figure>\n", escape(caption));
    page.pictures.push((name.to_owned(), svg.to_owned()));
}

/// The figures behind a diagram.
fn data(html: &mut String, figure: &Figure) {
    put!(
        html,
        "<details><summary>Figures</summary><div class=\"scroll\"><table>\n<tr><th></th><th>{} : {}</th></tr>\n",
        escape(figure.x),
        escape(figure.y)
    );
    for curve in &figure.curves {
        let points: Vec<String> = curve.points.iter().map(|(x, y)| format!("{x:.3e} : {y:.2e}")).collect();
        put!(
            html,
            "<tr><td>{}</td><td class=\"number\">{}</td></tr>\n",
            escape(&curve.label),
            points.join("<br>")
        );
    }
    put!(html, "</table></div></details>\n");
}

fn table(html: &mut String, table: &Table) {
    put!(html, "<div class=\"scroll\"><table>\n<caption>{}</caption>\n<tr>", escape(&table.caption));
    table.head.iter().for_each(|cell| {
        put!(html, "<th>{}</th>", escape(cell));
    });
    put!(html, "</tr>\n");
    for row in &table.rows {
        put!(html, "<tr>");
        row.iter().for_each(|cell| {
            put!(html, "<td class=\"number\">{}</td>", escape(cell));
        });
        put!(html, "</tr>\n");
    }
    put!(html, "</table></div>\n");
}

fn claims_table(html: &mut String, claims: &[&Claim], grouped: bool) {
    put!(
        html,
        "<div class=\"scroll\"><table>\n<tr><th>claim</th><th>expected</th><th>measured</th><th>holds</th></tr>\n"
    );
    let mut group = ("", "");
    for claim in claims {
        if grouped && group != (claim.suite, claim.case) {
            group = (claim.suite, claim.case);
            put!(html, "<tr class=\"group\"><td colspan=\"4\">{} · {}</td></tr>\n", claim.suite, claim.case);
        }
        let why = match claim.verdict {
            Verdict::Explained(why) => format!("<div class=\"why\">{}</div>", escape(why)),
            _ => String::new(),
        };
        put!(
            html,
            "<tr><td>{}{why}</td><td class=\"number\">{}</td>",
            escape(&claim.claim),
            escape(&claim.expected)
        );
        put!(
            html,
            "<td class=\"number\">{}</td><td class=\"mark {1}\">{1}</td></tr>\n",
            escape(&claim.measured),
            claim.holds()
        );
    }
    put!(html, "</table></div>\n");
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::{escape, page};
    use crate::verify::study::Study;

    #[test]
    fn the_page_needs_no_network() -> Result<(), meshless_output::OutputError> {
        let page = page(&[Study::new("gfdm")])?.html;
        assert!(!page.contains("http") && !page.contains("<script") && !page.contains("@import"));
        assert!(page.ends_with("</html>\n"));
        Ok(())
    }

    #[test]
    fn markup_in_texts_is_shown_not_obeyed() {
        assert_eq!(escape("a < b & \"c\""), "a &lt; b &amp; &quot;c&quot;");
    }
}
