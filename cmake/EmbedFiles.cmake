# catchlight_embed_files(TARGET VARIABLE FILES...): compiles text files into TARGET as a table {name, text}, declared in
# <embedded/VARIABLE.hpp>. Run with -P it writes that table.
if(CMAKE_SCRIPT_MODE_FILE)
  set(source "// Made by cmake/EmbedFiles.cmake.\n#include \"embedded/${VARIABLE}.hpp\"\n\nconst std::map<std::string, std::string, std::less<>>& ${VARIABLE}() {\n  static const std::map<std::string, std::string, std::less<>> files{\n")
  separate_arguments(files UNIX_COMMAND "${FILES}")
  foreach(file IN LISTS files)
    get_filename_component(name "${file}" NAME)
    file(READ "${file}" text)
    string(APPEND source "    {\"${name}\", R\"~embedded~(${text})~embedded~\"},\n")
  endforeach()
  string(APPEND source "  };\n  return files;\n}\n")
  file(WRITE "${OUTPUT}" "${source}")
  return()
endif()

set(CATCHLIGHT_EMBED_SCRIPT "${CMAKE_CURRENT_LIST_FILE}")
function(catchlight_embed_files target variable)
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/generated")
  set(output "${folder}/${variable}.cpp")
  file(WRITE "${folder}/embedded/${variable}.hpp.new" "#pragma once\n#include <functional>\n#include <map>\n#include <string>\n\n/// File name to text.\nconst std::map<std::string, std::string, std::less<>>& ${variable}();\n")
  configure_file("${folder}/embedded/${variable}.hpp.new" "${folder}/embedded/${variable}.hpp" COPYONLY)
  list(TRANSFORM ARGN PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/" OUTPUT_VARIABLE paths)
  string(JOIN " " joined ${paths})
  add_custom_command(
    OUTPUT "${output}"
    COMMAND ${CMAKE_COMMAND} "-DOUTPUT=${output}" "-DVARIABLE=${variable}" "-DFILES=${joined}" -P "${CATCHLIGHT_EMBED_SCRIPT}"
    DEPENDS ${paths} "${CATCHLIGHT_EMBED_SCRIPT}"
    VERBATIM)
  target_sources(${target} PRIVATE "${output}")
  target_include_directories(${target} PUBLIC "${folder}")
endfunction()
