//! Cutting a scene into the pieces that mutations move about. Nothing is lost: the pieces joined are the text.

/// What a piece is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Blanks, line breaks and comments.
    Blank,
    /// A number.
    Number,
    /// A text in quotes.
    Text,
    /// A name or keyword.
    Word,
    /// An opening bracket.
    Open,
    /// A closing bracket.
    Close,
    /// Anything else, one character.
    Other,
}

/// A piece of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Token {
    /// What it is.
    pub form: Form,
    /// How it is written.
    pub text: String,
}

/// Cuts a text into pieces.
pub fn tokens(text: &str) -> Vec<Token> {
    let mut all = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let (form, length) = piece(rest, first);
        all.push(Token { form, text: rest[..length].to_owned() });
        rest = &rest[length..];
    }
    all
}

fn piece(text: &str, first: char) -> (Form, usize) {
    let while_holds = |holds: &dyn Fn(char) -> bool| text.find(|letter| !holds(letter)).unwrap_or(text.len());
    match first {
        '/' if text.starts_with("//") => (Form::Blank, text.find('\n').unwrap_or(text.len())),
        '"' => {
            let mut escaped = false;
            let end = text[1..].char_indices().find(|&(_, letter)| {
                let ends = letter == '"' && !escaped;
                escaped = letter == '\\' && !escaped;
                ends
            });
            (Form::Text, end.map_or(text.len(), |(at, _)| at + 2))
        }
        '(' | '[' | '{' => (Form::Open, 1),
        ')' | ']' | '}' => (Form::Close, 1),
        _ if first.is_whitespace() => (Form::Blank, while_holds(&char::is_whitespace)),
        _ if first.is_ascii_digit() || first == '-' || first == '+' || first == '.' => {
            let number = |letter: char| letter.is_ascii_alphanumeric() || ".+-_".contains(letter);
            (Form::Number, while_holds(&number))
        }
        _ if first.is_alphanumeric() || first == '_' => {
            (Form::Word, while_holds(&|letter| letter.is_alphanumeric() || letter == '_'))
        }
        _ => (Form::Other, first.len_utf8()),
    }
}

/// The pieces as one text.
pub fn joined(tokens: &[Token]) -> String {
    tokens.iter().map(|token| token.text.as_str()).collect()
}

/// The place of the bracket that closes the one at `open`, or of the last piece.
pub fn closing(tokens: &[Token], open: usize) -> usize {
    let mut depth = 0_usize;
    for (index, token) in tokens.iter().enumerate().skip(open) {
        match token.form {
            Form::Open => depth += 1,
            Form::Close => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            return index;
        }
    }
    tokens.len() - 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_lost() {
        for text in ["", "Scene(a: -1e3, b: \"c\\\" d\") // end", "\"open", "é{[(']}", "1.5.6e+7 x_y"] {
            assert_eq!(joined(&tokens(text)), text);
        }
    }

    #[test]
    fn brackets_are_matched() {
        let scene = tokens("a(b[c]d)e");
        assert_eq!((closing(&scene, 1), closing(&scene, 3)), (7, 5));
        assert_eq!(closing(&tokens("((a"), 0), 2);
    }
}
