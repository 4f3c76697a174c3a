set(SOURCES bilateral.cpp)
set(SHADERS bilateral.comp)
set(TESTS bilateral_test.cpp)
