//! Code pages by the names and the numbers that tables have for them.

/// How texts are written.
#[derive(Clone, Copy)]
pub(super) enum Letters {
    /// A code page of the web's encoding standard.
    Page(&'static encoding_rs::Encoding),
    /// The upper half of a code page of DOS.
    Dos(&'static str),
    /// UTF-8 where it is that, else Latin-1.
    Guess,
}

/// The upper halves of code pages of DOS, by their numbers.
const DOS: [(u16, &str); 9] = [
    (
        437,
        "ÇüéâäàåçêëèïîìÄÅÉæÆôöòûùÿÖÜ¢£¥₧ƒáíóúñÑªº¿⌐¬½¼¡«»░▒▓│┤╡╢╖╕╣║╗╝╜╛┐└┴┬├─┼╞╟╚╔╩╦╠═╬╧╨╤╥╙╘╒╓╫╪┘┌█▄▌▐▀αßΓπΣσµτΦΘΩδ∞φε∩≡±≥≤⌠⌡÷≈°∙·√ⁿ²■\u{a0}",
    ),
    (
        737,
        "ΑΒΓΔΕΖΗΘΙΚΛΜΝΞΟΠΡΣΤΥΦΧΨΩαβγδεζηθικλμνξοπρσςτυφχψ░▒▓│┤╡╢╖╕╣║╗╝╜╛┐└┴┬├─┼╞╟╚╔╩╦╠═╬╧╨╤╥╙╘╒╓╫╪┘┌█▄▌▐▀ωάέήϊίόύϋώΆΈΉΊΌΎΏ±≥≤ΪΫ÷≈°∙·√ⁿ²■\u{a0}",
    ),
    (
        850,
        "ÇüéâäàåçêëèïîìÄÅÉæÆôöòûùÿÖÜø£Ø×ƒáíóúñÑªº¿®¬½¼¡«»░▒▓│┤ÁÂÀ©╣║╗╝¢¥┐└┴┬├─┼ãÃ╚╔╩╦╠═╬¤ðÐÊËÈıÍÎÏ┘┌█▄¦Ì▀ÓßÔÒõÕµþÞÚÛÙýÝ¯´\u{ad}±‗¾¶§÷¸°¨·¹³²■\u{a0}",
    ),
    (
        852,
        "ÇüéâäůćçłëŐőîŹÄĆÉĹĺôöĽľŚśÖÜŤťŁ×čáíóúĄąŽžĘę¬źČş«»░▒▓│┤ÁÂĚŞ╣║╗╝Żż┐└┴┬├─┼Ăă╚╔╩╦╠═╬¤đĐĎËďŇÍÎě┘┌█▄ŢŮ▀ÓßÔŃńňŠšŔÚŕŰýÝţ´\u{ad}˝˛ˇ˘§÷¸°¨˙űŘř■\u{a0}",
    ),
    (
        857,
        "ÇüéâäàåçêëèïîıÄÅÉæÆôöòûùİÖÜø£ØŞşáíóúñÑĞğ¿®¬½¼¡«»░▒▓│┤ÁÂÀ©╣║╗╝¢¥┐└┴┬├─┼ãÃ╚╔╩╦╠═╬¤ºªÊËÈ\u{fffd}ÍÎÏ┘┌█▄¦Ì▀ÓßÔÒõÕµ\u{fffd}×ÚÛÙìÿ¯´\u{ad}±\u{fffd}¾¶§÷¸°¨·¹³²■\u{a0}",
    ),
    (
        860,
        "ÇüéâãàÁçêÊèÍÔìÃÂÉÀÈôõòÚùÌÕÜ¢£Ù₧ÓáíóúñÑªº¿Ò¬½¼¡«»░▒▓│┤╡╢╖╕╣║╗╝╜╛┐└┴┬├─┼╞╟╚╔╩╦╠═╬╧╨╤╥╙╘╒╓╫╪┘┌█▄▌▐▀αßΓπΣσµτΦΘΩδ∞φε∩≡±≥≤⌠⌡÷≈°∙·√ⁿ²■\u{a0}",
    ),
    (
        861,
        "ÇüéâäàåçêëèÐðÞÄÅÉæÆôöþûÝýÖÜø£Ø₧ƒáíóúÁÍÓÚ¿⌐¬½¼¡«»░▒▓│┤╡╢╖╕╣║╗╝╜╛┐└┴┬├─┼╞╟╚╔╩╦╠═╬╧╨╤╥╙╘╒╓╫╪┘┌█▄▌▐▀αßΓπΣσµτΦΘΩδ∞φε∩≡±≥≤⌠⌡÷≈°∙·√ⁿ²■\u{a0}",
    ),
    (
        863,
        "ÇüéâÂà¶çêëèïî‗À§ÉÈÊôËÏûù¤ÔÜ¢£ÙÛƒ¦´óú¨¸³¯Î⌐¬½¼¾«»░▒▓│┤╡╢╖╕╣║╗╝╜╛┐└┴┬├─┼╞╟╚╔╩╦╠═╬╧╨╤╥╙╘╒╓╫╪┘┌█▄▌▐▀αßΓπΣσµτΦΘΩδ∞φε∩≡±≥≤⌠⌡÷≈°∙·√ⁿ²■\u{a0}",
    ),
    (
        865,
        "ÇüéâäàåçêëèïîìÄÅÉæÆôöòûùÿÖÜø£Ø₧ƒáíóúñÑªº¿⌐¬½¼¡«¤░▒▓│┤╡╢╖╕╣║╗╝╜╛┐└┴┬├─┼╞╟╚╔╩╦╠═╬╧╨╤╥╙╘╒╓╫╪┘┌█▄▌▐▀αßΓπΣσµτΦΘΩδ∞φε∩≡±≥≤⌠⌡÷≈°∙·√ⁿ²■\u{a0}",
    ),
];

/// The code pages that the language byte of a dBASE table stands for.
const LANGUAGES: [(u16, &[u8]); 24] = [
    (
        437,
        &[0x01, 0x09, 0x0b, 0x0d, 0x0f, 0x11, 0x15, 0x18, 0x19, 0x1b],
    ),
    (737, &[0x6a, 0x86]),
    (
        850,
        &[
            0x02, 0x0a, 0x0e, 0x10, 0x12, 0x14, 0x16, 0x1a, 0x1d, 0x25, 0x37,
        ],
    ),
    (852, &[0x1f, 0x22, 0x23, 0x40, 0x64, 0x87]),
    (857, &[0x6b, 0x88]),
    (860, &[0x24]),
    (861, &[0x67]),
    (863, &[0x1c, 0x6c]),
    (865, &[0x08, 0x17, 0x66]),
    (866, &[0x26, 0x65]),
    (874, &[0x50, 0x7c]),
    (932, &[0x13, 0x7b]),
    (936, &[0x4d, 0x7a]),
    (949, &[0x4e, 0x79]),
    (950, &[0x4f, 0x78]),
    (1250, &[0xc8]),
    (1251, &[0xc9]),
    (1252, &[0x03, 0x57, 0x58, 0x59]),
    (1253, &[0xcb]),
    (1254, &[0xca]),
    (1255, &[0x7d]),
    (1256, &[0x7e]),
    (1257, &[0xcc]),
    (10007, &[0x96]),
];

impl Letters {
    /// Those that a `.cpg` names; none where the name is not known.
    pub fn of_name(name: &str) -> Option<Letters> {
        let upper = name.trim().to_ascii_uppercase();
        if let Some((_, part)) = upper.split_once("8859") {
            return label(&format!("iso-8859-{}", part.trim_matches(['-', ' ', '_'])));
        }
        let number = upper.trim_start_matches(|c: char| !c.is_ascii_digit());
        let of_number = number.parse().ok().and_then(Letters::of_number);
        of_number.or_else(|| label(upper.trim_start_matches("ANSI ")))
    }

    /// Those that the language byte of a table stands for.
    pub fn of_language(byte: u8) -> Letters {
        let number = LANGUAGES.iter().find(|(_, bytes)| bytes.contains(&byte));
        let letters = number.and_then(|(number, _)| Letters::of_number(*number));
        letters.unwrap_or(Letters::Guess)
    }

    /// Those of a code page of DOS or Windows.
    fn of_number(number: u16) -> Option<Letters> {
        if let Some((_, upper)) = DOS.iter().find(|(known, _)| *known == number) {
            return Some(Letters::Dos(upper));
        }
        match number {
            866 => label("ibm866"),
            874 => label("windows-874"),
            932 => label("shift_jis"),
            936 => label("gbk"),
            949 => label("euc-kr"),
            950 => label("big5"),
            1250..=1258 => label(&format!("windows-{number}")),
            10007 => label("x-mac-cyrillic"),
            65001 => label("utf-8"),
            _ => None,
        }
    }

    /// The text that bytes stand for.
    pub fn text(self, bytes: &[u8]) -> String {
        match self {
            Letters::Page(page) => page.decode_without_bom_handling(bytes).0.into_owned(),
            Letters::Dos(upper) => bytes
                .iter()
                .map(|b| match b.checked_sub(128) {
                    Some(above) => upper.chars().nth(usize::from(above)).unwrap_or('\u{fffd}'),
                    None => char::from(*b),
                })
                .collect(),
            Letters::Guess => match std::str::from_utf8(bytes) {
                Ok(text) => text.to_string(),
                Err(_) => bytes.iter().map(|b| char::from(*b)).collect(),
            },
        }
    }
}

fn label(name: &str) -> Option<Letters> {
    let found = encoding_rs::Encoding::for_label(name.to_ascii_lowercase().as_bytes());
    found.map(Letters::Page)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_page_has_its_letters_by_byte_and_by_name() {
        for (_, upper) in DOS {
            assert_eq!(upper.chars().count(), 128);
        }
        let cases: [(u8, &str, &[u8], &str); 14] = [
            (0x08, "865", b"\x9b\x9d", "øØ"),
            (0x1f, "852", b"\xe7\xfd", "šř"),
            (0x26, "866", b"\xe0", "р"),
            (0x37, "850", b"\x8a", "è"),
            (0x64, "OEM 852", b"\x88", "ł"),
            (0x66, "cp865", b"\x86", "å"),
            (0x67, "861", b"\x8c", "ð"),
            (0x6a, "737", b"\x98", "α"),
            (0x6b, "857", b"\xa7", "ğ"),
            (0x7c, "874", b"\xa1", "ก"),
            (0x7d, "1255", b"\xe0", "א"),
            (0xcc, "ANSI 1257", b"\xf0", "š"),
            (0x01, "437", b"\xe1", "ß"),
            (0x57, "windows-1252", b"\xe9", "é"),
        ];
        for (byte, name, bytes, text) in cases {
            assert_eq!(Letters::of_language(byte).text(bytes), text, "{byte:#x}");
            let named = Letters::of_name(name).map(|letters| letters.text(bytes));
            assert_eq!(named.as_deref(), Some(text), "{name}");
        }
        for (name, text) in [("UTF-8", "é"), ("65001", "é"), ("utf8", "é")] {
            let named = Letters::of_name(name).map(|letters| letters.text("é".as_bytes()));
            assert_eq!(named.as_deref(), Some(text));
        }
        assert!(Letters::of_name("Klingon").is_none());
    }
}
