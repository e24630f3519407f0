// SPDX-License-Identifier: Apache-2.0
#include "material/lobe_grid.h"

void sheen_lobe_level(const LobeTable *t, unsigned level, float alpha[2])
{
    const LobeKey *key = &t->family.key;
    for (int i = 0; i < 2; ++i)
        alpha[i] = key->varies ? expf(t->log_alpha - (float)level * t->log_step) : key->alpha_hi[i];
}

Vec3 sheen_lobe_node_direction(const LobeTable *t, unsigned node)
{
    unsigned side = t->last + 1;
    float step = LOBE_RADIUS / (float)t->last;
    Vec2 p = v2((float)(node % side) * step, (float)(node / side) * step);
    float r = sqrtf(p.x * p.x + p.y * p.y), shrink = r > LOBE_RADIUS ? LOBE_RADIUS / r : 1.0f;
    p = v2(p.x * shrink, p.y * shrink); // nodes outside the disk stand for its border
    float scale = 2.0f / (1.0f + p.x * p.x + p.y * p.y);
    return v3_normalize(v3(scale * p.x, scale * p.y, scale - 1.0f));
}

/** Four nodes at, at + 1, ... of a line, and their weights for even and for odd functions. */
typedef struct Line {
    unsigned at;
    float weight[2][4], linear[4];
} Line;

/**
 * Cubic interpolation through the nodes with a continuous slope. A node before the first is the mirrored second; beyond
 * the last one there is the straight line of the last two. Source: catmull1974
 * @param u  in steps, in [0, last]
 */
static Line line_at(float u, unsigned last)
{
    unsigned i = (unsigned)u;
    if (i > last - 1) i = last - 1;
    float t = u - (float)i;
    const float w[4] = {0.5f * t * (t * (2.0f - t) - 1.0f), 0.5f * (t * t * (3.0f * t - 5.0f) + 2.0f),
                        0.5f * t * (t * (4.0f - 3.0f * t) + 1.0f), 0.5f * t * t * (t - 1.0f)};
    Line line = {.at = i == 0 ? 0 : i + 2 > last ? last - 3 : i - 1};
    line.linear[i - line.at] = 1.0f - t;
    line.linear[i + 1 - line.at] = t;
    for (int parity = 0; parity < 2; ++parity)
        for (unsigned k = 0; k < 4; ++k) {
            float *to = line.weight[parity];
            if (i + k == 0) {
                to[1] += parity ? -w[k] : w[k];
            } else if (i + k - 1 > last) {
                to[last - line.at] += 2.0f * w[k];
                to[last - 1 - line.at] -= w[k];
            } else {
                to[i + k - 1 - line.at] += w[k];
            }
        }
    return line;
}

static void add_level(const LobeTable *t, const Line *x, const Line *y, unsigned level, float share, LobeTaps *out)
{
    unsigned side = t->last + 1, rows = t->node.isotropic ? 1 : 4;
    for (unsigned j = 0; j < rows; ++j)
        for (unsigned i = 0; i < 4; ++i) {
            unsigned row = t->node.isotropic ? 0 : y->at + j, k = out->n++;
            out->node[k] = level * t->n_nodes + row * side + x->at + i;
            out->linear[k] = share * x->linear[i] * (t->node.isotropic ? 1.0f : y->linear[j]);
            for (unsigned parity = 0; parity < 4; ++parity) {
                float across = t->node.isotropic ? 1.0f : y->weight[parity >> 1][j];
                out->weight[parity][k] = share * x->weight[parity & 1][i] * across;
            }
        }
}

void sheen_lobe_taps(const LobeTable *t, Vec3 wo, float alpha, LobeTaps *out)
{
    float steps = (float)t->last / LOBE_RADIUS;
    Vec2 p = v2(wo.x / (1.0f + wo.z), wo.y / (1.0f + wo.z));
    float r = sqrtf(p.x * p.x + p.y * p.y);
    out->n = 0;
    out->fade = smoothstep((LOBE_RADIUS - r) * steps);
    if (!(out->fade > 0.0f)) return;
    Line x = line_at(p.x * steps, t->last), y = line_at(p.y * steps, t->last);
    if (!t->family.key.varies) {
        add_level(t, &x, &y, 0, 1.0f, out);
        return;
    }
    // Between the levels, linear in the logarithm of the roughness. There is nothing below the last, at which the share
    // has come to nothing, and above the first, which pictures with numbers beyond 1 have alone.
    float level = (t->log_alpha - logf(alpha)) / t->log_step, end = (float)(t->n_levels - 1);
    if (!(level >= -0.01f && level <= end + 0.01f)) out->fade = 0.0f;
    level = clampf(level, 0.0f, end);
    unsigned i = (unsigned)level;
    if (i + 1 >= t->n_levels) i = t->n_levels - 2;
    add_level(t, &x, &y, i, 1.0f - (level - (float)i), out);
    add_level(t, &x, &y, i + 1, level - (float)i, out);
}
