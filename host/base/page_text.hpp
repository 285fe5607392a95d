#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

// What pages are made of that are whole in one file.
namespace luciole {

/// JSON in which an HTML parser sees no tag. In JSON a '<' stands only in strings, where it can be escaped.
std::string embeddableJson(std::string json);

/// A script without the texts that would end it early, or hide its end, in an HTML file. In a script they
/// stand in strings, regular expressions and comments, where the backslash changes nothing.
std::string embeddableScript(std::string script);

/// `text` with each {{name}} replaced by what the list has for it, once: what is put in is not looked at
/// again.
std::string fillIn(std::string_view text,
                   const std::vector<std::pair<std::string_view, std::string>>& contents);

}  // namespace luciole
