# What is installed, where GNUInstallDirs says, and the Debian package made of it: cmake --build --preset package.
include(CMakePackageConfigHelpers)

# What is built for it, all or nothing: a file that is missing is told before the first one is copied. install(CODE) runs in the order
# of this file.
set(built $<TARGET_FILE:luciole> $<TARGET_FILE:luciole_library> $<TARGET_FILE:luciole_image_module>)
foreach(level IN LISTS LUCIOLE_BUILT_LEVELS)
  list(APPEND built $<TARGET_FILE:luciole_library${level}>)
endforeach()
set(TEXTS ${PROJECT_BINARY_DIR}/texts)
foreach(text changelog.gz CHANGELOG.md.gz README.md.gz NOTICE.gz luciole.1.gz luciole _luciole luciole.fish)
  list(APPEND built ${TEXTS}/${text})
endforeach()
list(JOIN built "\" \"" built_list)
install(CODE "foreach(file \"${built_list}\")
  if(NOT EXISTS \"\${file}\")
    message(FATAL_ERROR \"\${file} isn't built; nothing is installed. Build it all first: cmake --build ${PROJECT_BINARY_DIR} --target installed\")
  endif()
endforeach()")

# One path for both places of the program. CMake would fill a shorter one of the build folder up with colons, which to the loader
# mean the folder that it is called in. In /usr, the loader knows the place.
if(NOT CMAKE_SKIP_INSTALL_RPATH)
  file(RELATIVE_PATH to_library ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  set_target_properties(luciole PROPERTIES BUILD_WITH_INSTALL_RPATH ON INSTALL_RPATH "$ORIGIN/lib;$ORIGIN/${to_library}")
endif()
install(TARGETS luciole RUNTIME)
install(TARGETS luciole_library luciole_headers EXPORT LucioleTargets)
foreach(level IN LISTS LUCIOLE_BUILT_LEVELS)
  install(TARGETS luciole_library${level} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/glibc-hwcaps/${level} NAMELINK_SKIP)
endforeach()
# host/image/module.cpp looks for it there.
install(TARGETS luciole_image_module LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/luciole)

install(DIRECTORY host/include/luciole DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

set(config ${CMAKE_INSTALL_LIBDIR}/cmake/Luciole)
install(EXPORT LucioleTargets NAMESPACE luciole:: DESTINATION ${config})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/LucioleConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES packaging/LucioleConfig.cmake ${PROJECT_BINARY_DIR}/LucioleConfigVersion.cmake DESTINATION ${config})

# Scenes to try, and the kernels as messages of an OpenCL compiler name them; the program has its own inside.
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/luciole
  PATTERN "*.md" EXCLUDE PATTERN "*.sh" EXCLUDE PATTERN "*.py" EXCLUDE PATTERN __pycache__ EXCLUDE)
install(DIRECTORY kernels DESTINATION ${CMAKE_INSTALL_DATADIR}/luciole FILES_MATCHING PATTERN "*.cl" PATTERN "*.clh" PATTERN "*.h")

# Debian wants long texts compressed, without the time in them.
find_program(GZIP gzip REQUIRED)
file(MAKE_DIRECTORY ${TEXTS})
configure_file(packaging/changelog.in ${TEXTS}/changelog @ONLY)
foreach(text ${TEXTS}/changelog ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/NOTICE)
  get_filename_component(name ${text} NAME)
  add_custom_command(OUTPUT ${TEXTS}/${name}.gz COMMAND ${GZIP} -9nc ${text} > ${TEXTS}/${name}.gz DEPENDS ${text} VERBATIM)
  list(APPEND documents ${TEXTS}/${name}.gz)
endforeach()
install(FILES ${documents} LICENSE packaging/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The program knows its options: it writes its manual page and what shells complete by.
set(manual ${TEXTS}/luciole.1.gz)
add_custom_command(OUTPUT ${manual}
  COMMAND luciole man > ${TEXTS}/luciole.1 COMMAND ${GZIP} -9nf ${TEXTS}/luciole.1 DEPENDS luciole VERBATIM)
install(FILES ${manual} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
# Debian's zsh looks for those of packages elsewhere than zsh's own does.
set(zsh_folder site-functions)
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr" AND EXISTS /etc/debian_version)
  set(zsh_folder vendor-completions)
endif()
function(install_completion shell place name)
  set(output ${TEXTS}/${name})
  add_custom_command(OUTPUT ${output} COMMAND luciole completion ${shell} > ${output} DEPENDS luciole VERBATIM)
  install(FILES ${output} DESTINATION ${CMAKE_INSTALL_DATADIR}/${place})
endfunction()
install_completion(bash bash-completion/completions luciole)
install_completion(zsh zsh/${zsh_folder} _luciole)
install_completion(fish fish/vendor_completions.d luciole.fish)
# All that is installed. The launcher builds this.
add_custom_target(installed ALL DEPENDS ${documents} ${manual} ${TEXTS}/luciole ${TEXTS}/_luciole ${TEXTS}/luciole.fish)
add_dependencies(installed luciole luciole_image_module luciole_library)
foreach(level IN LISTS LUCIOLE_BUILT_LEVELS)
  add_dependencies(installed luciole_library${level})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Luciole authors <maintainers@luciole.example>")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib)
# What is found while it runs: a device, without which it makes no picture, the letters of heat maps, and the plots of a page.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "pocl-opencl-icd | opencl-icd")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "fonts-dejavu-core, libjs-chart.js")
# What its headers include.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libglm-dev")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Luciole (French: firefly) rasterizes a scene on the host and lights it by
OpenCL kernels, on any device, PoCL on a plain CPU first: point, directional
and spot lights without limit, shadows by four methods, fog, Phong's model and
others. It reads its own scenes, OBJ and glTF, writes EXR, PNG and what else
OpenImageIO writes, and says what a picture cost and how wrong it is.

The package holds the program, the library with its headers, and scenes to
try.")
# Who links the library asks for this package, and the loader learns of it. (CPack's own does so once a level, and by a script.)
set(soname "libluciole ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
file(WRITE ${PROJECT_BINARY_DIR}/debian/shlibs "${soname} luciole (>= ${PROJECT_VERSION})\n")
file(WRITE ${PROJECT_BINARY_DIR}/debian/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/debian/shlibs ${PROJECT_BINARY_DIR}/debian/triggers)
include(CPack)
