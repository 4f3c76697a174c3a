set(SOURCES temporal.cpp)
set(SHADERS temporal_accumulate.comp temporal_show.comp)
set(BUFFER_VARIANTS temporal_accumulate.comp)
