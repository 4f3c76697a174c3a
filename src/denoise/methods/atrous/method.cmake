set(SOURCES atrous.cpp)
set(SHADERS atrous_demodulate.comp atrous_level.comp atrous_level_buffers.comp atrous_modulate.comp)
set(BUFFER_VARIANTS atrous_demodulate.comp atrous_modulate.comp)
