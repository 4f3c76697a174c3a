set(SOURCES temporal.cpp)
set(SHADERS temporal_accumulate.comp)
