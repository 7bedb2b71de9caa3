// C++ tuned by hand: sixteen neighbouring points at a time, one in each lane of a vector.
//
// Points lie in blocks of sixteen. Slot s of a block holds the s-th spring of each of its points, so that the loop over
// lanes is vector code with gathers of the other ends. Every spring is evaluated from both of its ends; nothing is
// written that another block reads, so blocks go to any thread. Compiled with -ffast-math: it keeps no promise on bits.
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "network.hpp"

constexpr int LANES = 16;

struct alignas(64) Slot {
    int32_t other[LANES];
    float stiffness[LANES], damping[LANES], rest_length[LANES];
};

// Positions and velocities, one array for each component, padded to whole blocks.
struct State {
    std::vector<float> component[6];
};

class Lanes {
    const Network& network;
    std::vector<float> inverse_mass;
    std::vector<size_t> starts; // where each block's slots begin, and their total at the end
    std::vector<Slot> slots;
    State state, next;

public:
    Lanes(const Network& network, int threads) : network(network) {
        omp_set_num_threads(threads);
        const size_t points = network.points(), blocks = (points + LANES - 1) / LANES;
        inverse_mass = network.inverse_mass;
        inverse_mass.resize(blocks * LANES);

        std::vector<uint32_t> degree(blocks * LANES);
        for (const uint32_t end : network.ends) degree[end]++;
        starts.push_back(0);
        for (size_t block = 0; block < blocks; block++) {
            const auto first = degree.begin() + block * LANES;
            starts.push_back(starts.back() + *std::max_element(first, first + LANES));
        }
        // An empty place is a spring without stiffness from a point to itself.
        slots.resize(starts.back());
        for (size_t block = 0; block < blocks; block++)
            for (size_t slot = starts[block]; slot < starts[block + 1]; slot++)
                for (int lane = 0; lane < LANES; lane++) slots[slot].other[lane] = block * LANES + lane;

        std::vector<uint32_t> filled(blocks * LANES);
        for (size_t s = 0; s < network.springs(); s++) {
            for (int end = 0; end < 2; end++) {
                const uint32_t here = network.ends[2 * s + end], there = network.ends[2 * s + 1 - end];
                Slot& slot = slots[starts[here / LANES] + filled[here]++];
                const int lane = here % LANES;
                slot.other[lane] = there;
                slot.stiffness[lane] = network.stiffness[s];
                slot.damping[lane] = network.damping[s];
                slot.rest_length[lane] = network.rest_length[s];
            }
        }
        for (auto* of : {&state, &next})
            for (auto& values : of->component) values.resize(blocks * LANES);
        reset();
    }

    void reset() {
        for (size_t p = 0; p < network.points(); p++) {
            for (int axis = 0; axis < 3; axis++) {
                state.component[axis][p] = network.position[3 * p + axis];
                state.component[3 + axis][p] = network.velocity[3 * p + axis];
            }
        }
    }

    void step() {
        const long blocks = starts.size() - 1;
#pragma omp parallel for schedule(static)
        for (long block = 0; block < blocks; block++) advance(block);
        std::swap(state, next);
    }

    float position(size_t point, int axis) const { return state.component[axis][point]; }

private:
    void advance(long block) {
        const float *x = state.component[0].data(), *y = state.component[1].data(), *z = state.component[2].data();
        const float *vx = state.component[3].data(), *vy = state.component[4].data(), *vz = state.component[5].data();
        const long first = block * LANES;
        alignas(64) float fx[LANES] = {}, fy[LANES] = {}, fz[LANES] = {};
        for (size_t at = starts[block]; at < starts[block + 1]; at++) {
            const Slot& slot = slots[at];
#pragma omp simd
            for (int lane = 0; lane < LANES; lane++) {
                const long i = first + lane;
                const int32_t j = slot.other[lane];
                const float ex = x[i] - x[j], ey = y[i] - y[j], ez = z[i] - z[j];
                const float square = ex * ex + ey * ey + ez * ez + 1e-30f; // never 0/0 in an empty place
                const float inverse = 1 / std::sqrt(square);
                const float speed = ((vx[i] - vx[j]) * ex + (vy[i] - vy[j]) * ey + (vz[i] - vz[j]) * ez) * inverse;
                const float tension =
                    slot.stiffness[lane] * (square * inverse - slot.rest_length[lane]) + slot.damping[lane] * speed;
                fx[lane] -= tension * inverse * ex;
                fy[lane] -= tension * inverse * ey;
                fz[lane] -= tension * inverse * ez;
            }
        }
        const float dt = network.dt, gravity = network.gravity;
        auto& to = next.component;
#pragma omp simd
        for (int lane = 0; lane < LANES; lane++) {
            const long i = first + lane;
            const float w = inverse_mass[i];
            to[3][i] = vx[i] + fx[lane] * w * dt;
            to[4][i] = vy[i] + (fy[lane] * w + (w > 0 ? gravity : 0)) * dt;
            to[5][i] = vz[i] + fz[lane] * w * dt;
            to[0][i] = x[i] + to[3][i] * dt;
            to[1][i] = y[i] + to[4][i] * dt;
            to[2][i] = z[i] + to[5][i] * dt;
        }
    }
};

int main(int, char** arguments) { return converse<Lanes>(arguments[1], std::stoi(arguments[2])); }
