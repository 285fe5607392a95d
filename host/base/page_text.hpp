#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Text for HTML pages that consist of one file.
namespace luciole {

/// JSON that contains no HTML tag: '<', which JSON has in strings only, is escaped.
std::string embeddableJson(std::string json);

/// A script without the texts "</script" and "<!--", which would end it early, or hide its end, in an HTML
/// file. Scripts have them in strings, regular expressions and comments, where the inserted backslash changes
/// nothing.
std::string embeddableScript(std::string script);

/// `text` with each {{name}} replaced by its entry in the list. Replacements aren't searched for names.
std::string fillIn(std::string_view text,
                   const std::vector<std::pair<std::string_view, std::string>>& contents);

}  // namespace luciole
