#pragma once

#include <string>
#include <string_view>

namespace luciole {

/// The number of bytes of the UTF-8 character that `text` begins with; 0 where it begins with none.
std::size_t utf8Length(std::string_view text);

bool isUtf8(std::string_view text);

/// The text as UTF-8: bytes that are no part of a UTF-8 character are taken as Latin-1's, as names in old OBJ
/// files and on old disks are. Text that is UTF-8 stays as it is.
std::string utf8Of(std::string_view text);

}  // namespace luciole
