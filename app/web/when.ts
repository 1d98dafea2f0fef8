// Times as people read them, in the browser's own zone.
const withinYear: Intl.DateTimeFormatOptions = { day: 'numeric', month: 'short', hour: '2-digit', minute: '2-digit' };

/** "26 Nov, 09:05", with the year where it is another; as it is where it is no time. */
export function shortTime(utc: string): string {
  const time = new Date(utc);
  if (Number.isNaN(time.getTime())) return utc;
  const isThisYear = time.getFullYear() === new Date().getFullYear();
  return time.toLocaleString('en-GB', isThisYear ? withinYear : { ...withinYear, year: 'numeric' });
}

/** "45.1 s", "3 min 20 s". */
export function duration(seconds: number): string {
  if (seconds < 60) return `${seconds.toFixed(1)} s`;
  const whole = Math.round(seconds);
  return `${Math.floor(whole / 60)} min ${whole % 60} s`;
}
