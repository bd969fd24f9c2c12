// The filter's modes as they are shown, everywhere in the same colour. FEJ often lies on the invariant
// filter: drawn after it and thinner, both are seen.

const MODES = {
  invariant: { label: "invariant", color: "run-1", width: 3 },
  fej: { label: "FEJ", color: "run-3", width: 1 },
  standard: { label: "standard", color: "run-2", width: 1.5 },
};

export const lookOf = ({ name }) => MODES[name] ?? { label: name, color: "muted" };
