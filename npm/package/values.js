// What users pass in: vectors, numbers, options, ranges. Everything else is a clear error.

import { mistake } from "./errors.js";

/** How an error shows a value. */
function shown(value) {
    if (typeof value === "string") return JSON.stringify(value.slice(0, 40));
    if (typeof value === "function") return "a function";
    if (Array.isArray(value) || ArrayBuffer.isView(value)) {
        return value.length > 6 ? `a list of ${value.length}` : `[${Array.from(value, shown).join(", ")}]`;
    }
    if (typeof value === "object" && value !== null) return `an object with ${Object.keys(value).join(", ") || "no keys"}`;
    return String(value);
}

function wrong(field, value, must) {
    if (value === undefined) return mistake("MissingField", field, `is missing, and must be ${must}`);
    return mistake("WrongType", field, `is ${shown(value)}, and must be ${must}`);
}

export function number(value, field) {
    if (typeof value !== "number") throw wrong(field, value, "a number");
    return value;
}

export function text(value, field) {
    if (typeof value !== "string") throw wrong(field, value, "a text");
    return value;
}

export function flag(value, field) {
    if (typeof value !== "boolean") throw wrong(field, value, "true or false");
    return value;
}

/** One of these. */
export function choice(value, field, allowed) {
    if (!allowed.includes(value)) throw wrong(field, value, `one of ${allowed.map(shown).join(", ")}`);
    return value;
}

/** Three numbers: an array, or an object with x, y and z as three.js has them. */
export function vector(value, field) {
    const isList = Array.isArray(value) || ArrayBuffer.isView(value);
    const parts = isList ? Array.from(value) : [value?.x, value?.y, value?.z];
    if (parts.length === 3 && parts.every((part) => typeof part === "number")) return parts;
    throw wrong(field, value, "three numbers, such as [0, 1, 0] or { x: 0, y: 1, z: 0 }");
}

/** So many numbers. */
export function numbers(value, field, count) {
    const parts = Array.isArray(value) || ArrayBuffer.isView(value) ? Array.from(value) : [];
    if (parts.length === count && parts.every((part) => typeof part === "number")) return parts;
    throw wrong(field, value, `${count} numbers`);
}

/** An object of options with no other keys than these: a misspelt one would do nothing, without a word. */
export function options(value, field, allowed) {
    if (value === undefined) return {};
    if (typeof value !== "object" || value === null || Array.isArray(value)) throw wrong(field, value, "an object");
    for (const key of Object.keys(value)) {
        if (!allowed.includes(key)) {
            throw mistake("UnknownKey", field, `has "${key}", which is not a known key; allowed here are ${allowed.join(", ")}`);
        }
    }
    return value;
}

/** Stiffness (N/m) and damping (N·s/m). */
export function material(given, field, more = []) {
    const { stiffness, damping = 0 } = options(given ?? {}, field, ["stiffness", "damping", ...more]);
    return [number(stiffness, "stiffness"), number(damping, "damping")];
}

/** Nine numbers for each plane. */
export function planes(value) {
    if (!Array.isArray(value)) throw wrong("planes", value, "a list of planes");
    return value.flatMap((plane, index) => {
        const field = `planes[${index}]`;
        const allowed = ["y", "point", "normal", "stiffness", "damping", "law"];
        const { y, point, normal = [0, 1, 0], stiffness, damping = 0, law = "push" } = options(plane ?? {}, field, allowed);
        if (y !== undefined && point !== undefined) {
            throw mistake("Conflict", field, "has both y and point", "say y for a level plane, else point and normal");
        }
        return [
            ...(point === undefined ? [0, number(y, `${field}.y`), 0] : vector(point, `${field}.point`)),
            ...vector(normal, `${field}.normal`),
            number(stiffness, `${field}.stiffness`),
            number(damping, `${field}.damping`),
            choice(law, `${field}.law`, ["push", "report"]) === "report" ? 1 : 0,
        ];
    });
}

/** Keys and values in turn, the values as a scene file writes them. */
export function changes(set) {
    return Object.entries(options(set, "set", Object.keys(set ?? {}))).flatMap(([key, value]) => {
        // As on a command line, where a text may be anything that a scene file has there.
        const written = typeof value === "string" ? value : toml(value, key);
        return [key, written];
    });
}

function toml(value, field) {
    if (typeof value === "number") {
        if (Number.isNaN(value)) return "nan";
        if (!Number.isFinite(value)) return value > 0 ? "inf" : "-inf";
        return String(value);
    }
    if (typeof value === "boolean") return String(value);
    if (typeof value === "string") return JSON.stringify(value);
    if (Array.isArray(value) || ArrayBuffer.isView(value)) {
        return `[${Array.from(value, (entry) => toml(entry, field)).join(", ")}]`;
    }
    if (value?.isVector3) return toml([value.x, value.y, value.z], field);
    if (typeof value === "object" && value !== null) {
        const entries = Object.entries(value).map(([key, entry]) => `${JSON.stringify(key)} = ${toml(entry, field)}`);
        return `{ ${entries.join(", ")} }`;
    }
    throw wrong(field, value, "a number, a text, true or false, a list or an object");
}

/**
 * A range of points or springs, from the first to the end (not included): one index, `[first, end]`, what a builder made, or
 * the name of a body or joint. `named` are these, `count` is how many points or springs there are in all.
 */
export function range(where, field, count, named) {
    if (where === undefined) return [0, count];
    if (typeof where === "number") return [where, where + 1];
    if (typeof where === "string") {
        const found = named.find(({ name }) => name === where);
        if (found) return found.range;
        const names = named.map(({ name }) => JSON.stringify(name)).join(", ");
        throw mistake("NotFound", field, `there is nothing called ${shown(where)}; there are ${names}`);
    }
    if (typeof where?.first === "number" && typeof where?.end === "number") return [where.first, where.end];
    if (Array.isArray(where) && where.length === 2) return numbers(where, field, 2);
    throw wrong(field, where, "an index, [first, end], or the name of a body");
}
