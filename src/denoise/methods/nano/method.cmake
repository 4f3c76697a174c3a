set(SOURCES nano.cpp nano_matrices.cpp nano_network.cpp nano_recorder.cpp
            nano_tiles.cpp)
set(SHADERS shaders/nano_around_matrix.comp shaders/nano_convolve.comp shaders/nano_features.comp
            shaders/nano_filter.comp shaders/nano_finest.comp shaders/nano_mix.comp shaders/nano_pool.comp
            shaders/nano_within_matrix.comp)
set(BUFFER_VARIANTS shaders/nano_convolve.comp shaders/nano_features.comp shaders/nano_filter.comp
                    shaders/nano_finest.comp shaders/nano_mix.comp shaders/nano_pool.comp)
