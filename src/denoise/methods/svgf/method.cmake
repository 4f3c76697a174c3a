set(SOURCES svgf.cpp svgf_lags.cpp svgf_parameters.cpp)
set(SHADERS
  shaders/svgf_antilag.comp shaders/svgf_antilag_buffers.comp shaders/svgf_lags.comp
  shaders/svgf_last_level.comp shaders/svgf_level.comp shaders/svgf_reproject.comp
  shaders/svgf_reproject_buffers.comp shaders/svgf_tiles.comp shaders/svgf_variance.comp
  shaders/svgf_variance_buffers.comp shaders/svgf_young.comp shaders/svgf_young_buffers.comp)
set(BUFFER_VARIANTS shaders/svgf_last_level.comp shaders/svgf_level.comp)
