set(SOURCES atrous.cpp)
set(SHADERS atrous_demodulate.comp atrous_level.comp)
set(BUFFER_VARIANTS atrous_demodulate.comp atrous_level.comp)
