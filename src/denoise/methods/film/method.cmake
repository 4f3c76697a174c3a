set(SOURCES film.cpp film_network.cpp)
