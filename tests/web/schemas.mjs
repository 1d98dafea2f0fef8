// A judge of messages: as much of JSON Schema as Foxglove's schemas use.
import { packages } from './programs.mjs';

const published = packages('@foxglove/schemas/jsonschema');

/** Foxglove's own schema of this name; nothing for ours. */
export const officialSchema = (name) => published[name.replace('foxglove.', '')];

const typeFits = {
  object: (value) => typeof value === 'object' && value !== null && !Array.isArray(value),
  array: Array.isArray,
  string: (value) => typeof value === 'string',
  boolean: (value) => typeof value === 'boolean',
  number: (value) => typeof value === 'number',
  integer: Number.isInteger,
};

/** What is wrong with a value; a key that the schema does not name is wrong too. */
export function complaints(schema, value, where = '') {
  if (schema.oneOf) return schema.oneOf.some((one) => one.const === value) ? [] : [`${where}: ${value} is none of the choices`];
  if (!typeFits[schema.type](value)) return [`${where}: wanted ${schema.type}, found ${JSON.stringify(value)}`];
  if (schema.type === 'object' && schema.properties) {
    const missing = (schema.required ?? []).filter((key) => !(key in value)).map((key) => `${where}: no ${key}`);
    return missing.concat(Object.entries(value).flatMap(([key, part]) => key in schema.properties
      ? complaints(schema.properties[key], part, `${where}/${key}`) : [`${where}: ${key} is unknown`]));
  }
  if (schema.type === 'array') {
    if (value.length < (schema.minItems ?? 0) || value.length > (schema.maxItems ?? Infinity)) return [`${where}: ${value.length} items`];
    return value.flatMap((item, i) => complaints(schema.items, item, `${where}/${i}`));
  }
  if (value < (schema.minimum ?? -Infinity) || value > (schema.maximum ?? Infinity)) return [`${where}: ${value} is out of bounds`];
  return [];
}
