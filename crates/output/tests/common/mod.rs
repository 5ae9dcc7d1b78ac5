//! A small check that a document is well-formed XML, enough for SVG without comments or entities of its own.

/// What is wrong with the document, if anything.
pub(crate) fn xml_fault(text: &str) -> Option<String> {
    if let Some(c) = text.chars().find(|c| c.is_control() && !"\n\t\r".contains(*c)) {
        return Some(format!("control character {c:?}"));
    }
    let mut open: Vec<&str> = Vec::new();
    let mut rest = text;
    while let Some(start) = rest.find('<') {
        if let Some(fault) = text_fault(&rest[..start]) {
            return Some(fault);
        }
        let Some(length) = rest[start..].find('>') else { return Some("unclosed tag".into()) };
        let tag = &rest[start + 1..start + length];
        rest = &rest[start + length + 1..];
        if let Some(name) = tag.strip_prefix('/') {
            if open.pop() != Some(name) {
                return Some(format!("unexpected </{name}>"));
            }
            continue;
        }
        let (body, empty) = tag.strip_suffix('/').map_or((tag, false), |body| (body, true));
        let (name, attributes) = body.split_once(char::is_whitespace).unwrap_or((body, ""));
        if let Some(fault) = attribute_fault(attributes) {
            return Some(format!("<{name}>: {fault}"));
        }
        if !empty {
            open.push(name);
        }
    }
    match open.pop() {
        Some(name) => Some(format!("<{name}> is not closed")),
        None => text_fault(rest).or_else(|| (!rest.trim().is_empty()).then(|| "text after the end".into())),
    }
}

fn text_fault(text: &str) -> Option<String> {
    let entities = ["&amp;", "&lt;", "&gt;", "&quot;", "&apos;"];
    let bare = text.match_indices('&').any(|(at, _)| !entities.iter().any(|e| text[at..].starts_with(e)));
    (bare || text.contains('>')).then(|| format!("unescaped character in {text:?}"))
}

fn attribute_fault(mut rest: &str) -> Option<String> {
    let mut names = Vec::new();
    loop {
        rest = rest.trim_start();
        if rest.is_empty() {
            return None;
        }
        let Some((name, after)) = rest.split_once("=\"") else {
            return Some(format!("no value in {rest:?}"));
        };
        let Some((value, after)) = after.split_once('"') else {
            return Some(format!("open quote in {rest:?}"));
        };
        if names.contains(&name) {
            return Some(format!("{name} twice"));
        }
        names.push(name);
        let number_like = !["font-family", "xmlns"].contains(&name);
        if value.contains('<') || text_fault(value).is_some() || (number_like && value.contains("NaN")) {
            return Some(format!("{name} = {value:?}"));
        }
        rest = after;
    }
}
