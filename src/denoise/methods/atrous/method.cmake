set(SOURCES atrous.cpp)
set(SHADERS
  atrous_demodulate.comp atrous_demodulate_buffers.comp atrous_level.comp atrous_level_buffers.comp atrous_modulate.comp
  atrous_modulate_buffers.comp)
