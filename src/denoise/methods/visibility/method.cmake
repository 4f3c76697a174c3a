set(SOURCES visibility.cpp)
set(SHADERS shaders/visibility_accumulate.comp shaders/visibility_antilag.comp shaders/visibility_level.comp)
set(BUFFER_VARIANTS ${SHADERS})
