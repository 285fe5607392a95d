#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace luciole {

/// Text of OBJ and MTL files: lines of words that blanks and control characters separate.

/// The text without a UTF-8 byte order mark at its start.
std::string_view withoutMark(std::string_view text);

std::string_view trimmed(std::string_view words);

/// Takes the next word off the front of `rest`; empty at the end.
std::string_view takeWord(std::string_view& rest);

/// Takes the next line off the front of `rest`, trimmed. Lines end with \n, \r or \r\n.
std::string_view takeLine(std::string_view& rest);

/// Takes the next line off the front of `rest`, with those that a backslash at its end continues, unless it
/// ends a comment, and sets how many `lines` these were. `joined` keeps the characters of a statement of
/// several lines.
std::string_view takeStatement(std::string_view& rest, std::string& joined, int& lines);

/// The words before a comment. The # of "1.#IND", which some programs write for NaN, begins none.
std::string_view withoutComment(std::string_view words);

/// A name without a trailing comment, which begins with # as a word of its own. With `any_word` any word that
/// begins with # begins a comment, as in "wood #brown", which may be a name, too.
std::string_view nameWithoutComment(std::string_view name, bool any_word = false);

/// A name without quotes around it.
std::string_view withoutQuotes(std::string_view name);

/// A number that a float can hold; one too near to 0 for that is 0. Nothing for nan, inf and other words.
std::optional<float> finiteNumber(std::string_view word);
/// The same in double precision, of a number that a float can hold.
std::optional<double> finiteDouble(std::string_view word);

/// Whether two keywords are the same, but for the case of ASCII letters. `lower` is in small letters.
bool isKeyword(std::string_view word, std::string_view lower);

}  // namespace luciole
