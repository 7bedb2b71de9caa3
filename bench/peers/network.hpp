// What the C++ programs share: the network of network.py, and the conversation that stands at the head of measure.py.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

struct Network {
    float dt, gravity;
    std::vector<float> position, velocity, inverse_mass;
    std::vector<uint32_t> ends;
    std::vector<float> stiffness, damping, rest_length;

    size_t points() const { return inverse_mass.size(); }
    size_t springs() const { return stiffness.size(); }
};

template <class T>
std::vector<T> read(std::istream& file, size_t count) {
    std::vector<T> values(count);
    file.read(reinterpret_cast<char*>(values.data()), count * sizeof(T));
    if (!file) throw std::runtime_error("the network's file is too short");
    return values;
}

inline Network read_network(const char* path) {
    std::ifstream file(path, std::ios::binary);
    const auto magic = read<char>(file, 8);
    if (std::memcmp(magic.data(), "network1", 8) != 0) throw std::runtime_error("the file holds no network");
    const auto counts = read<uint32_t>(file, 2);
    const size_t n = counts[0], m = counts[1];
    const auto numbers = read<float>(file, 2);
    // Braces are evaluated from left to right: the order of the file.
    return {numbers[0], numbers[1], read<float>(file, 3 * n), read<float>(file, 3 * n), read<float>(file, n),
            read<uint32_t>(file, 2 * m), read<float>(file, m), read<float>(file, m), read<float>(file, m)};
}

inline double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Makes an engine of the network and answers what is asked of it. An engine has reset(), step() and position(point, axis).
template <class Engine>
int converse(const char* path, int threads) {
    const Network network = read_network(path);
    double begun = now();
    Engine engine(network, threads);
    engine.step();
    std::printf("{\"setup_s\": %.9f}\n", now() - begun);
    std::fflush(stdout);

    std::string command;
    while (std::cin >> command) {
        if (command == "run") {
            int steps, times;
            std::cin >> steps >> times;
            double best = 1e30;
            while (times-- > 0) {
                engine.reset();
                begun = now();
                for (int step = 0; step < steps; step++) engine.step();
                best = std::min(best, now() - begun);
            }
            std::printf("{\"best_s\": %.9f}\n", best);
        } else if (command == "save") {
            std::string name;
            std::cin >> name;
            std::ofstream file(name, std::ios::binary);
            for (size_t at = 0; at < 3 * network.points(); at++) {
                const double value = engine.position(at / 3, at % 3);
                file.write(reinterpret_cast<const char*>(&value), sizeof value);
            }
            file.close();
            std::printf("{}\n");
        }
        std::fflush(stdout);
    }
    return 0;
}
