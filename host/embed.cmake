# cmake -DOUTPUT=x.cpp -DFILES=a;b -DBASE=folder -DTABLE=name -P embed.cmake: writes a C++ file that holds the files' bytes and the
# function `name` that gives a table of them by their paths in the folder, declared in host/base/embedded_files.hpp.
set(arrays "")
set(table "")
foreach(file ${FILES})
  file(RELATIVE_PATH name ${BASE} ${file})
  string(MAKE_C_IDENTIFIER ${name} identifier)
  file(READ ${file} hex HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
  string(APPEND arrays "const unsigned char ${identifier}[] = {${bytes}};\n")
  string(APPEND table "    {\"${name}\", {reinterpret_cast<const char*>(${identifier}), sizeof ${identifier}}},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"base/embedded_files.hpp\"\n\nnamespace {\n${arrays}}\n\nnamespace luciole {\n"
  "const std::vector<EmbeddedFile>& ${TABLE}() {\n  static const std::vector<EmbeddedFile> files{\n${table}  };\n"
  "  return files;\n}\n}\n")
