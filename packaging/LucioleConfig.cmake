# find_package(Luciole): luciole::luciole, the library of the program luciole, with what its headers include.
include(CMakeFindDependencyMacro)
find_dependency(glm)
include(${CMAKE_CURRENT_LIST_DIR}/LucioleTargets.cmake)
