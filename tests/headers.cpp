// Has the headers compiled that the tests share (CMakeLists.txt).
