// Plain C++: an array of springs, each of which adds its force to both of its ends. As one writes it on the first day.
#include <cmath>

#include "network.hpp"

struct Vec {
    float x, y, z;
};

static Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
static Vec operator*(Vec a, float s) { return {a.x * s, a.y * s, a.z * s}; }
static void operator+=(Vec& a, Vec b) { a = {a.x + b.x, a.y + b.y, a.z + b.z}; }
static void operator-=(Vec& a, Vec b) { a = a - b; }
static float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

struct Spring {
    uint32_t i, j;
    float stiffness, damping, rest_length;
};

class Plain {
    const Network& network;
    std::vector<Spring> springs;
    std::vector<Vec> x, v, force;

public:
    Plain(const Network& network, int) : network(network), force(network.points()) {
        for (size_t s = 0; s < network.springs(); s++) {
            springs.push_back({network.ends[2 * s], network.ends[2 * s + 1], network.stiffness[s], network.damping[s],
                               network.rest_length[s]});
        }
        reset();
    }

    void reset() {
        x.resize(network.points());
        v.resize(network.points());
        std::memcpy(x.data(), network.position.data(), sizeof(Vec) * x.size());
        std::memcpy(v.data(), network.velocity.data(), sizeof(Vec) * v.size());
    }

    void step() {
        for (const Spring& s : springs) {
            const Vec axis = x[s.i] - x[s.j];
            const float length = std::sqrt(dot(axis, axis));
            const Vec u = axis * (1 / length);
            const float speed = dot(v[s.i] - v[s.j], u);
            const Vec pull = u * (s.stiffness * (length - s.rest_length) + s.damping * speed);
            force[s.i] -= pull;
            force[s.j] += pull;
        }
        for (size_t p = 0; p < x.size(); p++) {
            const float w = network.inverse_mass[p];
            if (w > 0) {
                v[p] += (Vec{force[p].x * w, force[p].y * w + network.gravity, force[p].z * w}) * network.dt;
                x[p] += v[p] * network.dt;
            }
            force[p] = {0, 0, 0};
        }
    }

    float position(size_t point, int axis) const { return (&x[point].x)[axis]; }
};

int main(int, char** arguments) { return converse<Plain>(arguments[1], std::stoi(arguments[2])); }
