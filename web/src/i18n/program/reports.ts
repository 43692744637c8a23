/** Portuguese texts of the reports. */
export const reports: Record<string, string> = {};
